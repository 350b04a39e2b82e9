"""Closed-form kinematics of deltas: three spheres about the ends of the arms or carriages intersect in P. SI units."""

import numpy as np

TURNS = [np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]]) for a in 2 * np.pi / 3 * np.arange(3)]


def meeting(centres, length, start):
    """The point at this distance from three centres, near the start (Newton)."""
    point = np.array(start, float)
    for _ in range(20):
        apart = point - centres
        point -= np.linalg.solve(2.0 * apart, (apart**2).sum(1) - length**2)
    return point


class Linear:
    """Three vertical drives, three rods that keep the platform parallel. P is `below` the carriages at home."""

    def __init__(self, offset, below):
        self.offset, self.below, self.length = offset, below, np.hypot(offset, below)

    def centres(self, q, home_z):
        return np.array([turn @ (self.offset, 0, home_z + self.below + way) for turn, way in zip(TURNS, q)])

    def ways(self, pose, home_z):
        feet = np.array([turn @ (self.offset, 0, 0) for turn in TURNS])
        flat = ((feet - np.array(pose))[:, :2] ** 2).sum(1)
        return pose[2] + np.sqrt(self.length**2 - flat) - home_z - self.below

    def moved(self, pose, scales, home_z, start=0.0):
        q = self.ways(pose, home_z)
        return meeting(self.centres(q + scales * (q - start), home_z), self.length, pose) - pose
