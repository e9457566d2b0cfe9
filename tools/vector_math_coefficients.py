#!/usr/bin/env python3
"""Minimax coefficients of lib/simd/vector_math.hpp (needs mpmath).

log: log((1+s)/(1-s)) = 2 s + s z P(z), z = s*s, s in [0, s_max] with s_max = (sqrt 2 - 1)/(sqrt 2 + 1)
exp: exp(r) = 1 + r + r*r Q(r), |r| <= log(2)/2
Remez exchange on the relative error of the whole function, 60 digits; prints the coefficients as hexadecimal doubles,
lowest power first, and the largest relative error with the rounded coefficients.
"""
from mpmath import mp, mpf, atanh, cos, exp, log, lu_solve, matrix, pi, sqrt

mp.dps = 60


def remez(function, weight, lower, upper, degree, rounds=8, samples=4000):
    """Polynomial of least max |weight (polynomial - function)| on [lower, upper]."""
    count = degree + 2
    nodes = [(lower + upper) / 2 - (upper - lower) / 2 * cos(pi * i / (count - 1)) for i in range(count)]
    grid = [lower + (upper - lower) * i / samples for i in range(samples + 1)]
    exact = [function(x) for x in grid]
    scale = [weight(x) for x in grid]
    for _ in range(rounds):
        system = matrix(count, count)
        right = matrix(count, 1)
        for row, x in enumerate(nodes):
            for power in range(degree + 1):
                system[row, power] = x**power
            system[row, degree + 1] = (-1) ** row / weight(x)
            right[row] = function(x)
        coefficients = list(lu_solve(system, right))[: degree + 1]
        error = [w * (evaluate(coefficients, x) - f) for x, f, w in zip(grid, exact, scale)]
        # The extreme of each run of one sign: the next set of nodes.
        extremes, start = [], 0
        for i in range(1, len(grid) + 1):
            if i == len(grid) or (error[i] > 0) != (error[start] > 0):
                extremes.append(max(range(start, i), key=lambda j: abs(error[j])))
                start = i
        if len(extremes) < count:
            break
        while len(extremes) > count:
            extremes.pop(0 if abs(error[extremes[0]]) < abs(error[extremes[-1]]) else -1)
        nodes = [grid[i] for i in extremes]
    return coefficients


def evaluate(coefficients, x):
    result = mpf(0)
    for c in reversed(coefficients):
        result = result * x + c
    return result


def report(name, function, weight, lower, upper, degree):
    coefficients = [mpf(float(c)) for c in remez(function, weight, lower, upper, degree)]
    points = [lower + (upper - lower) * (i + mpf(1) / 3) / 3000 for i in range(3000)]
    worst = max(abs(weight(x) * (evaluate(coefficients, x) - function(x))) for x in points)
    print(f"{name}: degree {degree}, largest relative error {float(worst):.2e}")
    for c in coefficients:
        print(f"  {float(c).hex()}")


tiny = mpf(10) ** -6
s_max = (sqrt(mpf(2)) - 1) / (sqrt(mpf(2)) + 1)


def log_tail(z):
    s = sqrt(z)
    return (2 * atanh(s) - 2 * s) / (s * z)


def exp_tail(r):
    return (exp(r) - 1 - r) / r**2 if abs(r) > tiny else mpf(1) / 2 + r / 6 + r**2 / 24 + r**3 / 120


for degree in (5, 6):
    report("log", log_tail, lambda z: z / 2, tiny, s_max**2 * (1 + tiny), degree)
for degree in (8, 9):
    bound = log(mpf(2)) / 2 + tiny
    report("exp", exp_tail, lambda r: r**2 / exp(r) + mpf(10) ** -12, -bound, bound, degree)
