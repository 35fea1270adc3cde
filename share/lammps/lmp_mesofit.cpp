/* ----------------------------------------------------------------------
   SPDX-License-Identifier: GPL-2.0-or-later
   lmp with pair_style mesofit/table, of an installed LAMMPS library: the
   style is added to the list of those it was built with, and the input is
   run as lmp runs it.
------------------------------------------------------------------------- */

#include "force.h"
#include "input.h"
#include "lammps.h"

#include "pair_mesofit_table.h"

#include <mpi.h>

using namespace LAMMPS_NS;

static Pair *create(LAMMPS *lmp)
{
  return new PairMesofitTable(lmp);
}

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  {
    LAMMPS lammps(argc, argv, MPI_COMM_WORLD);
    (*lammps.force->pair_map)["mesofit/table"] = &create;
    lammps.input->file();
  }
  MPI_Finalize();
  return 0;
}
