"""A delta of six rods on three carriages, solved by Newton's method (NumPy). The program is compared with it."""

import numpy as np

ROD, REACH, RADIUS, HALF = 0.217, 0.095, 0.030, 0.023
PLACES = np.array([(0, 0, 0)] + [(0.05 * np.cos(a), 0.05 * np.sin(a), 0) for a in np.radians(range(0, 360, 60))])


def turned(points, k):
    c, s = np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ points


# The carriage of rods 1 to 6: carriage k has rods k and k + 3.
CARRIAGE = np.array([0, 1, 2, 0, 1, 2])
UP = np.array([turned([REACH + RADIUS, side * HALF, 0], k) for side in (1, -1) for k in range(3)])
DOWN = np.array([turned([RADIUS, side * HALF, 0], k) for side in (1, -1) for k in range(3)])


def rotations(vectors):
    """Of rotation vectors [N x 3]."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    hat = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    half = np.sinc(angle / (2 * np.pi)) ** 2 / 2
    return np.eye(3) + np.sinc(angle / np.pi) * hat + half * hat @ hat


def heights(places):
    """Of the carriages without errors, [M x 3]."""
    across = np.linalg.norm((UP - DOWN - places[:, None])[:, :, :2], axis=2)
    return (places[:, 2:] + np.sqrt(ROD**2 - across**2))[:, :3]


class Machines:
    """Platforms [N] on rods of these lengths [N x 6], carriages at these heights [N x 3], by Newton's method."""

    def __init__(self, lengths, carriages, places):
        self.lengths, self.carriages, self.places = lengths, carriages.copy(), places
        self.R, self.p = np.tile(np.eye(3), (len(places), 1, 1)), places.copy()
        self.settle()

    def arms(self):
        return np.einsum("nij,kj->nki", self.R, DOWN)

    def legs(self):
        ends = np.repeat(UP[None], len(self.places), axis=0)
        ends[:, :, 2] = self.carriages[:, CARRIAGE]
        return self.arms() + self.p[:, None] - ends

    def jacobian(self):
        """Of the rods' lengths by the platform's twist [turn, displacement]: [N x 6 x 6]."""
        legs = self.legs()
        along = legs / np.linalg.norm(legs, axis=2)[:, :, None]
        return np.concatenate([np.cross(self.arms(), along), along], axis=2)

    def settle(self):
        for _ in range(8):
            open_by = self.lengths - np.linalg.norm(self.legs(), axis=2)
            step = np.linalg.solve(self.jacobian(), open_by[:, :, None])[:, :, 0]
            self.R, self.p = rotations(step[:, :3]) @ self.R, self.p + step[:, 3:]
            if np.abs(step).max() < 1e-10:  # the next step would be about its square
                break
        assert np.abs(self.lengths - np.linalg.norm(self.legs(), axis=2)).max() < 1e-14

    def moved(self):
        """The points that the rods hold, from where they should be: [N x 6 x 3]."""
        return self.arms() + self.p[:, None] - (DOWN + self.places[:, None])

    def by_motors(self):
        """Their displacement by each motor, [N x 18 x 3]: a motor lifts both rods of its carriage."""
        J = self.jacobian()
        lifts = J[:, :, 5, None] * np.eye(3)[CARRIAGE]
        twists = np.linalg.solve(J, lifts)
        turns = np.cross(twists[:, None, :3], self.arms()[:, :, :, None], axisa=2, axisb=2, axisc=2)
        return (turns + twists[:, None, 3:]).reshape(len(self.places), 18, 3)

    def correct(self):
        """Moves the motors to where the points' displacement is least: Gauss and Newton's method."""
        for _ in range(4):
            A, moved = self.by_motors(), self.moved().reshape(-1, 18)
            At = A.transpose(0, 2, 1)
            self.carriages -= np.linalg.solve(At @ A, At @ moved[:, :, None])[:, :, 0]
            self.settle()
        return self

    def rotation(self):
        return np.arccos(np.clip((np.trace(self.R, axis1=1, axis2=2) - 1) / 2, -1, 1))


def rod_effects():
    """What each rod does by its length to [turn; displacement] of the effector, to first order: [places x 6 x rods]."""
    return np.linalg.inv(machines(np.zeros((1, 6))).jacobian())


def machines(rods):
    """Each machine with these errors of its rods [N x 6] at each place, place by place: N x 7 platforms."""
    lengths = np.repeat(ROD + rods, len(PLACES), axis=0)
    places = np.tile(PLACES, (len(rods), 1))
    return Machines(lengths, heights(places), places)
