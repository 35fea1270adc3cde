/* ----------------------------------------------------------------------
   SPDX-License-Identifier: GPL-2.0-or-later
   pair_style mesofit/table as a plugin: plugin load mesofit_plugin.so
------------------------------------------------------------------------- */

#include "lammpsplugin.h"
#include "version.h"

#include "pair_mesofit_table.h"

using namespace LAMMPS_NS;

static Pair *create(LAMMPS *lmp)
{
  return new PairMesofitTable(lmp);
}

extern "C" void lammpsplugin_init(void *lmp, void *handle, void *regfunc)
{
  lammpsplugin_t plugin;
  auto register_plugin = (lammpsplugin_regfunc) regfunc;
  plugin.version = LAMMPS_VERSION;
  plugin.style = "pair";
  plugin.name = "mesofit/table";
  plugin.info = "tabulated potential and friction weight of mesofit";
  plugin.author = "the authors of mesofit";
  plugin.creator.v1 = (lammpsplugin_factory1 *) &create;
  plugin.handle = handle;
  (*register_plugin)(&plugin, lmp);
}
