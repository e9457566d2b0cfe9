#!/usr/bin/python3
"""The rings of examples/scenes/rings by finite elements: when they part, and how fast. An independent reference.

  rings_reference.py [CELLS ...]      cells through the ring's 10 mm, default 4 6 9 (some minutes)

By symmetry one ring meets a rigid smooth wall halfway; y = 0 and z = 0 are mirrors. Trilinear bricks with eight points each, total
Lagrangian, the scene's neo-Hookean law P = (lambda ln J - G) F^-T + G F, central differences with lumped mass; a node that would
pass the wall is put on it, and the impulse that this takes is the contact force. What is lost is the energy of the nodes that the
wall stops: some percent, less the finer the mesh.
"""

import sys

import numpy as np

BULK, SHEAR, DENSITY = 121.7, 26.1, 1.01e-3  # MPa, MPa, g/mm3: ms, mm, g
INNER, OUTER, THICKNESS, GAP, SPEED, END = 30.0, 40.0, 12.0, 4.0, 30.0, 4.8
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1],
                    [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], dtype=float)


def mesh(radial, around, high):
    radius, angle, z = np.meshgrid(np.linspace(INNER, OUTER, radial + 1), np.linspace(0, np.pi, around + 1),
                                   np.linspace(0, THICKNESS / 2, high + 1), indexing="ij")
    nodes = np.stack([-OUTER - GAP / 2 + radius * np.cos(angle), radius * np.sin(angle), z], axis=-1).reshape(-1, 3)
    number = np.arange(len(nodes)).reshape(radius.shape)
    bricks = np.stack([number[i:radial + i, j:around + j, k:high + k].ravel()
                       for i, j, k in ((CORNERS + 1) / 2).astype(int)], axis=1)
    return nodes, bricks


def integration(nodes, bricks):
    """Derivatives of the shape functions and weights at all points, and the nodes' masses."""
    slopes, weights, mass = [], [], np.zeros(len(nodes))
    for point in CORNERS / np.sqrt(3):
        factors = 1 + CORNERS * point
        local = np.stack([CORNERS[:, i] * factors[:, (i + 1) % 3] * factors[:, (i + 2) % 3] for i in range(3)], axis=1) / 8
        jacobian = np.einsum("eai,aj->eij", nodes[bricks], local)
        weight = np.linalg.det(jacobian)
        slopes.append(np.einsum("aj,eji->eai", local, np.linalg.inv(jacobian)))
        weights.append(weight)
        for corner in range(8):
            np.add.at(mass, bricks[:, corner], DENSITY * weight * factors.prod(axis=1)[corner] / 8)
    return np.stack(slopes, axis=1), np.stack(weights, axis=1), mass


def internal_force(place, bricks, slopes, weights):
    gradient = np.einsum("eai,eqaj->eqij", place[bricks], slopes)
    ratio = np.log(np.linalg.det(gradient))
    inverse = np.swapaxes(np.linalg.inv(gradient), -1, -2)
    stress = ((BULK - 2 * SHEAR / 3) * ratio - SHEAR)[..., None, None] * inverse + SHEAR * gradient
    share = -np.einsum("eq,eqij,eqaj->eai", weights, stress, slopes)
    return np.stack([np.bincount(bricks.ravel(), share[..., i].ravel(), len(place)) for i in range(3)], axis=1)


def collide(cells):
    radial, around, high = cells, round(50 * cells / 3), max(2, round(cells / 2))
    nodes, bricks = mesh(radial, around, high)
    slopes, weights, mass = integration(nodes, bricks)
    place, velocity = nodes.copy(), np.zeros_like(nodes)
    velocity[:, 0] = SPEED
    middle, bottom = np.abs(nodes[:, 1]) < 1e-9, nodes[:, 2] < 1e-9
    smallest = min((OUTER - INNER) / radial, np.pi * INNER / around, THICKNESS / 2 / high)
    step = 0.6 * smallest / (np.sqrt((BULK + 4 * SHEAR / 3) / DENSITY) + SPEED)
    last = 0.0
    for k in range(int(END / step)):
        velocity += step * internal_force(place, bricks, slopes, weights) / mass[:, None]
        velocity[middle, 1] = velocity[bottom, 2] = 0
        passing = place[:, 0] + step * velocity[:, 0] > 0
        if passing.any():
            velocity[passing, 0] = -place[passing, 0] / step
            last = (k + 1) * step
        place += step * velocity
    return last, -(mass * velocity[:, 0]).sum() / mass.sum()


for cells in [int(word) for word in sys.argv[1:]] or [4, 6, 9]:
    time, speed = collide(cells)
    print(f"{cells} bricks through the ring: last contact {time:.3f} ms, rebound {speed:.2f} m/s", flush=True)
