# SPDX-License-Identifier: GPL-3.0-or-later
"""An optimiser of one's own looks for a potential: the simplex of Nelder and Mead, in scipy, asks the
fit for the error of each candidate, always with the same noise. Usage: own_optimiser.py RUN.json"""

import sys

import scipy.optimize

import mesofit


def main(file):
    problem = mesofit.Problem(file)
    start = problem.start()
    begin = problem.evaluate(start)
    print(f"{len(problem)} coefficients; the start is off by {begin.error:.4f}")
    found = scipy.optimize.minimize(problem, start, method="Nelder-Mead", bounds=problem.bounds,
                                    options={"maxfev": 80})
    print(f"after {found.nfev} simulations {found.fun:.4f}")
    # The least of many noisy errors is a lucky one: another seed is fair.
    fair = problem.evaluate(found.x, seed=2)
    print(f"with another seed {fair.error:.4f}, which scatters by {fair.variance ** 0.5:.4f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        main(sys.argv[1])
    except mesofit.Error as error:
        sys.exit(f"own_optimiser.py: {error}")
