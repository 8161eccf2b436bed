#!/usr/bin/python3
"""Compares the QP solver with an independent one: CVXOPT's interior-point method.

usage: qp_against_cvxopt.py QP_PROBLEMS

Runs the program QP_PROBLEMS, whose source describes its output, and solves each of its problems
again. Fails if a solution breaks a limit, or if its cost is more than 1e-6 (relative) above that of
CVXOPT. Also fails if a cost is so low that CVXOPT must be wrong, or if fewer than 900 of 1,000
problems have active limits.
"""
import array
import subprocess
import sys

from cvxopt import blas, lapack, matrix, solvers

PROBLEMS = 1000
WITH_ACTIVE_LIMITS = 900
COST_TOLERANCE = 1e-6  # relative
COST_FLOOR = 1e-3  # below this cost, the tolerance is 1e-9, because CVXOPT stops at 1e-10
LIMIT_TOLERANCE = 1e-8  # in the units of a row; the values of a row are up to some hundreds

solvers.options.update(show_progress=False, abstol=1e-10, reltol=1e-10, feastol=1e-10, maxiters=200)


class Reader:
    def __init__(self, data):
        self.values = array.array("d", data)
        self.position = 0

    def at_end(self):
        return self.position == len(self.values)

    def number(self):
        self.position += 1
        return self.values[self.position - 1]

    def matrix(self, rows, columns=1):
        begin, self.position = self.position, self.position + rows * columns
        return matrix(self.values[begin : self.position], (rows, columns))


def cost(hessian, linear, x):
    return 0.5 * blas.dot(x, hessian * x) + blas.dot(linear, x)


def one_sided(constraints, lower, upper):
    """G and h of G x <= h, for the limits that are finite."""
    infinity = float("inf")
    high = [i for i in range(len(upper)) if upper[i] != infinity]
    low = [i for i in range(len(lower)) if lower[i] != -infinity]
    rows = matrix([constraints[high, :], -constraints[low, :]])
    return rows, matrix([upper[high], -lower[low]])


def worst_violation(rows, limits, x):
    return max(rows * x - limits)


def main():
    data = subprocess.run([sys.argv[1]], check=True, stdout=subprocess.PIPE).stdout
    reader = Reader(data)
    problems = active = failures = 0
    largest_difference = 0.0
    while not reader.at_end():
        n, m = int(reader.number()), int(reader.number())
        hessian, linear = reader.matrix(n, n), reader.matrix(n)
        constraints = reader.matrix(m, n)
        rows, limits = one_sided(constraints, reader.matrix(m), reader.matrix(m))
        x = reader.matrix(n)

        unconstrained = -linear
        lapack.posv(+hessian, unconstrained)
        active += worst_violation(rows, limits, unconstrained) > LIMIT_TOLERANCE

        other = solvers.qp(hessian, linear, rows, limits)
        other_cost = cost(hessian, linear, other["x"])
        difference = (cost(hessian, linear, x) - other_cost) / max(COST_FLOOR, abs(other_cost))
        violation = worst_violation(rows, limits, x)
        largest_difference = max(largest_difference, abs(difference))
        if abs(difference) > COST_TOLERANCE or violation > LIMIT_TOLERANCE:
            failures += 1
            print(
                f"problem {problems} ({n} variables, {m} rows): relative difference of cost "
                f"{difference:.2e}, violation {violation:.2e}, CVXOPT says {other['status']}"
            )
        problems += 1

    print(
        f"{problems} problems, {active} with active limits, {failures} failures, "
        f"largest relative difference of cost {largest_difference:.1e}"
    )
    return failures == 0 and problems == PROBLEMS and active >= WITH_ACTIVE_LIMITS


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(0 if main() else 1)
