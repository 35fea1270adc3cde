/* -*- c++ -*- ----------------------------------------------------------
   SPDX-License-Identifier: GPL-2.0-or-later
   A pair style for LAMMPS (https://www.lammps.org/): README.md beside this
   file tells how to build it.
------------------------------------------------------------------------- */

#ifdef PAIR_CLASS
// clang-format off
PairStyle(mesofit/table,PairMesofitTable);
// clang-format on
#else

#ifndef LMP_PAIR_MESOFIT_TABLE_H
#define LMP_PAIR_MESOFIT_TABLE_H

#include "pair.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/* A tabulated potential phi(r) and a tabulated friction weight omega(r):
     F_ij = ( -phi'(r) - omega(r)^2 (e.v_ij) + sqrt(2 k_B T/dt) omega(r) z ) e
   with e = r_ij/r and z = z_ij = z_ji normal. R. D. Groot and P. B. Warren,
   J. Chem. Phys. 107, 4423 (1997), eqs. 4 to 8, with omega^2 = gamma w_D. */
class PairMesofitTable : public Pair {
 public:
  PairMesofitTable(class LAMMPS *);
  ~PairMesofitTable() override;
  void compute(int, int) override;
  void settings(int, char **) override;
  void coeff(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;

 protected:
  /* Rows equally far apart in r^2 (phi, force/r) or in r (omega). */
  struct Section {
    double low, high, inverse;           // of x = r^2 or r, and rows per x
    std::vector<double> first, second;   // phi and force/r; or omega
  };

  double temperature;
  bigint seed;
  std::vector<Section> sections;
  int **potential, **omega;    // section of a pair of types; omega -1: none

  void allocate();
  int read_section(const std::string &file, const std::string &key, bool squares);
  double normal(tagint i, tagint j) const;
};

}    // namespace LAMMPS_NS

#endif
#endif
