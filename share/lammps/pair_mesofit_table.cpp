/* ----------------------------------------------------------------------
   SPDX-License-Identifier: GPL-2.0-or-later

     pair_style mesofit/table T seed
     pair_coeff I J file PHI [OMEGA]

   T: temperature of the noise. PHI and OMEGA: keywords of sections of
   `file`, as "mesofit export --engine lammps" writes them:
     PHI                    OMEGA
     N 20001 RSQ 0.001 10   N 1025 R 0 8
     (empty line)           (empty line)
     1 r energy force       1 r omega
   PHI is what pair_style table linear reads with N of the file; a pair
   nearer than its first row has the force/r of that row. Without OMEGA
   there is no friction between the two types. Restart files do not keep
   these tables: give pair_style and pair_coeff again after read_restart.

   Velocities of ghosts are needed (comm_modify vel yes), and fix nve. The
   noise of a pair is a function of seed, time step and the two atom ids, so
   that both processors that compute a pair with newton off agree on it, and
   momentum is conserved; it does not depend on the number of processors.
------------------------------------------------------------------------- */

#include "pair_mesofit_table.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "neigh_list.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>

using namespace LAMMPS_NS;

static constexpr double NEAREST = 1.0e-10;    // r can be 0 in soft systems
static constexpr double TWO_PI = 6.28318530717958647692;

/* ---------------------------------------------------------------------- */

PairMesofitTable::PairMesofitTable(LAMMPS *lmp) : Pair(lmp), temperature(0.0), seed(0),
    potential(nullptr), omega(nullptr)
{
  single_enable = 0;
  restartinfo = 0;
  writedata = 0;
}

/* ---------------------------------------------------------------------- */

PairMesofitTable::~PairMesofitTable()
{
  if (copymode) return;
  if (allocated) {
    memory->destroy(setflag);
    memory->destroy(cutsq);
    memory->destroy(potential);
    memory->destroy(omega);
  }
}

/* ----------------------------------------------------------------------
   Philox4x32-10: J. K. Salmon et al., Proc. SC11, 16 (2011)
------------------------------------------------------------------------- */

static void philox(uint32_t counter[4], uint32_t key0, uint32_t key1)
{
  for (int round = 0; round < 10; round++) {
    const uint64_t p = (uint64_t) 0xD2511F53u * counter[0];
    const uint64_t q = (uint64_t) 0xCD9E8D57u * counter[2];
    const uint32_t next[4] = {(uint32_t) (q >> 32) ^ counter[1] ^ key0, (uint32_t) q,
                              (uint32_t) (p >> 32) ^ counter[3] ^ key1, (uint32_t) p};
    for (int k = 0; k < 4; k++) counter[k] = next[k];
    key0 += 0x9E3779B9u;
    key1 += 0xBB67AE85u;
  }
}

/* ----------------------------------------------------------------------
   a normal number of mean 0 and variance 1, the same for (i, j) and (j, i)
------------------------------------------------------------------------- */

double PairMesofitTable::normal(tagint i, tagint j) const
{
  const auto step = (uint64_t) update->ntimestep;
  uint32_t c[4] = {(uint32_t) std::min(i, j), (uint32_t) std::max(i, j), (uint32_t) step,
                   (uint32_t) (step >> 32)};
  philox(c, (uint32_t) seed, (uint32_t) ((uint64_t) seed >> 32));
  const double u = (c[0] + 0.5) / 4294967296.0, v = (c[1] + 0.5) / 4294967296.0;
  return sqrt(-2.0 * log(u)) * cos(TWO_PI * v);
}

/* ---------------------------------------------------------------------- */

void PairMesofitTable::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);

  double **x = atom->x;
  double **v = atom->v;
  double **f = atom->f;
  int *type = atom->type;
  tagint *tag = atom->tag;
  const int nlocal = atom->nlocal;
  const int newton_pair = force->newton_pair;
  double *special_lj = force->special_lj;
  const double noise = sqrt(2.0 * force->boltz * temperature / update->dt);

  for (int ii = 0; ii < list->inum; ii++) {
    const int i = list->ilist[ii];
    const int itype = type[i];
    const int *jlist = list->firstneigh[i];

    for (int jj = 0; jj < list->numneigh[i]; jj++) {
      const double factor = special_lj[sbmask(jlist[jj])];
      const int j = jlist[jj] & NEIGHMASK;
      const int jtype = type[j];
      const double delx = x[i][0] - x[j][0];
      const double dely = x[i][1] - x[j][1];
      const double delz = x[i][2] - x[j][2];
      const double rsq = delx * delx + dely * dely + delz * delz;
      if (rsq >= cutsq[itype][jtype]) continue;

      double fpair = 0.0, energy = 0.0;
      const Section &phi = sections[potential[itype][jtype]];
      if (rsq < phi.high) {
        const double place = std::max(rsq - phi.low, 0.0) * phi.inverse;
        const auto k = std::min((size_t) place, phi.first.size() - 2);
        const double share = place - k;
        energy = phi.first[k] + share * (phi.first[k + 1] - phi.first[k]);
        fpair = phi.second[k] + share * (phi.second[k + 1] - phi.second[k]);
      }

      if (omega[itype][jtype] >= 0 && rsq > NEAREST * NEAREST) {
        const Section &weight = sections[omega[itype][jtype]];
        const double r = sqrt(rsq);
        if (r < weight.high) {
          const double place = std::max(r - weight.low, 0.0) * weight.inverse;
          const auto k = std::min((size_t) place, weight.first.size() - 2);
          const double w =
              weight.first[k] + (place - k) * (weight.first[k + 1] - weight.first[k]);
          if (w != 0.0) {
            const double approach = (delx * (v[i][0] - v[j][0]) + dely * (v[i][1] - v[j][1]) +
                                     delz * (v[i][2] - v[j][2])) / r;
            fpair += w * (noise * normal(tag[i], tag[j]) - w * approach) / r;
          }
        }
      }

      fpair *= factor;
      f[i][0] += delx * fpair;
      f[i][1] += dely * fpair;
      f[i][2] += delz * fpair;
      if (newton_pair || j < nlocal) {
        f[j][0] -= delx * fpair;
        f[j][1] -= dely * fpair;
        f[j][2] -= delz * fpair;
      }
      if (evflag)
        ev_tally(i, j, nlocal, newton_pair, factor * energy, 0.0, fpair, delx, dely, delz);
    }
  }

  if (vflag_fdotr) virial_fdotr_compute();
}

/* ---------------------------------------------------------------------- */

void PairMesofitTable::allocate()
{
  allocated = 1;
  const int n = atom->ntypes + 1;
  memory->create(setflag, n, n, "pair:setflag");
  memory->create(cutsq, n, n, "pair:cutsq");
  memory->create(potential, n, n, "pair:potential");
  memory->create(omega, n, n, "pair:omega");
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      setflag[i][j] = 0;
      potential[i][j] = omega[i][j] = -1;
    }
}

/* ----------------------------------------------------------------------
   temperature and seed
------------------------------------------------------------------------- */

void PairMesofitTable::settings(int narg, char **arg)
{
  if (narg != 2) error->all(FLERR, std::string("Illegal pair_style command: mesofit/table T seed"));
  temperature = utils::numeric(FLERR, arg[0], false, lmp);
  seed = utils::bnumeric(FLERR, arg[1], false, lmp);
  if (temperature < 0.0) error->all(FLERR, std::string("pair mesofit/table: temperature below 0"));
  if (seed < 0) error->all(FLERR, std::string("pair mesofit/table: seed below 0"));
}

/* ----------------------------------------------------------------------
   file and keywords for one or more pairs of types
------------------------------------------------------------------------- */

void PairMesofitTable::coeff(int narg, char **arg)
{
  if (narg < 4 || narg > 5)
    error->all(FLERR, std::string("Illegal pair_coeff command: I J file PHI [OMEGA] for mesofit/table"));
  if (!allocated) allocate();

  int ilo, ihi, jlo, jhi, count = 0;
  utils::bounds(FLERR, arg[0], 1, atom->ntypes, ilo, ihi, error);
  utils::bounds(FLERR, arg[1], 1, atom->ntypes, jlo, jhi, error);
  const int phi = read_section(arg[2], arg[3], true);
  const int weight = narg > 4 ? read_section(arg[2], arg[4], false) : -1;

  for (int i = ilo; i <= ihi; i++)
    for (int j = std::max(jlo, i); j <= jhi; j++) {
      potential[i][j] = phi;
      omega[i][j] = weight;
      setflag[i][j] = 1;
      count++;
    }
  if (count == 0) error->all(FLERR, std::string("Incorrect args for pair coefficients"));
}

/* ----------------------------------------------------------------------
   read a section on the first processor and give it to all; its number
------------------------------------------------------------------------- */

int PairMesofitTable::read_section(const std::string &file, const std::string &key, bool squares)
{
  Section section;
  int rows = 0;
  double ends[2] = {0.0, 0.0};
  std::string fault;

  if (comm->me == 0) {
    std::ifstream stream(file);
    std::string line, word, kind, name;
    bool found = false;
    while (!found && std::getline(stream, line)) {
      std::istringstream words(line);
      found = (words >> word) && word == key;
    }
    std::getline(stream, line);
    std::istringstream words(line);
    if (!found)
      fault = "no section " + key + " in " + file;
    else if (!(words >> name >> rows >> kind >> ends[0] >> ends[1]) || name != "N" || rows < 2 ||
             kind != (squares ? "RSQ" : "R") || !(ends[0] < ends[1]))
      fault = "section " + key + " of " + file + " has no line N n " + (squares ? "RSQ" : "R") +
          " low high";
    double number, r, value, slope = 0.0;
    for (int k = 0; fault.empty() && k < rows; k++) {
      if (!(stream >> number >> r >> value) || (squares && !(stream >> slope))) {
        fault = "section " + key + " of " + file + " ends before its " + std::to_string(rows) +
            " rows";
        break;
      }
      section.first.push_back(value);
      if (squares) section.second.push_back(slope / r);
    }
  }

  int failed = fault.empty() ? 0 : 1;
  MPI_Bcast(&failed, 1, MPI_INT, 0, world);
  if (comm->me == 0 && failed) error->one(FLERR, "pair mesofit/table: " + fault);
  MPI_Bcast(&rows, 1, MPI_INT, 0, world);
  MPI_Bcast(ends, 2, MPI_DOUBLE, 0, world);
  section.first.resize(rows);
  section.second.resize(squares ? rows : 0);
  MPI_Bcast(section.first.data(), rows, MPI_DOUBLE, 0, world);
  if (squares) MPI_Bcast(section.second.data(), rows, MPI_DOUBLE, 0, world);
  section.low = squares ? ends[0] * ends[0] : ends[0];
  section.high = squares ? ends[1] * ends[1] : ends[1];
  section.inverse = (rows - 1) / (section.high - section.low);
  sections.push_back(section);
  return (int) sections.size() - 1;
}

/* ---------------------------------------------------------------------- */

void PairMesofitTable::init_style()
{
  if (comm->ghost_velocity == 0)
    error->all(FLERR, std::string("Pair mesofit/table needs velocities of ghost atoms: comm_modify vel yes"));
  if (!atom->tag_enable) error->all(FLERR, std::string("Pair mesofit/table needs atom ids"));
  Pair::init_style();
}

/* ----------------------------------------------------------------------
   the cutoff of a pair of types
------------------------------------------------------------------------- */

double PairMesofitTable::init_one(int i, int j)
{
  if (setflag[i][j] == 0) error->all(FLERR, std::string("All pair coeffs are not set"));
  potential[j][i] = potential[i][j];
  omega[j][i] = omega[i][j];
  const double cutoff = sqrt(sections[potential[i][j]].high);
  return omega[i][j] < 0 ? cutoff : std::max(cutoff, sections[omega[i][j]].high);
}
