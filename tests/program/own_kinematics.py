"""Which machines can be put together: kinematics of their own for three mechanisms of tests/data/mechanisms, at one pose.
Errors are arrays [N] by name; those that are not named are zero. `margins` are positive where a machine can be put
together, and count by how much (m). SI throughout."""

import numpy as np


def of(errors, name, count):
    return np.broadcast_to(errors.get(name, 0.0), count)


def plane_vectors(errors, name, limb, count):
    """[N x 2]"""
    return np.stack([of(errors, f"{name}_{axis}_{limb}", count) for axis in "xy"], -1)


def turned(angle, vectors):
    """Vectors of the plane [... x 2], turned."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack(np.broadcast_arrays(cosine * x - sine * y, sine * x + cosine * y), -1)


class FiveBar:
    """The circles of the distal links about the elbows meet, or do not."""

    file = "five-bar.toml"
    pose = {"x": 0.0, "y": 0.062}
    lengths = ["motor_x_1", "motor_y_1", "motor_x_2", "motor_y_2", "crank_1", "crank_2", "distal"]

    def margins(self, errors, count):
        elbows = []
        for limb, side in ((1, -1.0), (2, 1.0)):
            motor, elbow = np.array([side * 0.05, 0.0]), np.array([side * 0.08, 0.06])
            direction = (elbow - motor) / np.linalg.norm(elbow - motor)
            stretch = of(errors, f"crank_{limb}", count)[:, None] * direction
            elbows.append(elbow + plane_vectors(errors, "motor", limb, count) + stretch)
        reach = 2.0 * np.hypot(0.08, 0.002) + of(errors, "distal", count)
        return reach - np.linalg.norm(elbows[1] - elbows[0], axis=-1)


class FiveBarWithArm(FiveBar):
    """The same with the link behind an elbow as a body between two limbs, and a bearing that gives way."""

    file = "five-bar-arm.toml"


class ThreeRpr:
    """For each rotation of the platform two legs place it, and the third is too long or too short. It fits somewhere if
    it is too short where it is least too long."""

    file = "rpr3.toml"
    pose = {"x": 0.01, "y": 0.005, "phi": np.radians(-50.0)}
    lengths = [f"leg_{k}" for k in (1, 2, 3)] + [f"plat_{axis}_{k}" for k in (1, 2, 3) for axis in "xy"]
    angles = 2.0 * np.pi * np.arange(3) / 3.0
    base = 0.1 * np.stack([np.cos(angles), np.sin(angles)], -1)
    platform = 0.04 * np.stack([np.cos(angles + np.pi / 3.0), np.sin(angles + np.pi / 3.0)], -1)

    def margins(self, errors, count):
        place = np.array([self.pose["x"], self.pose["y"]])
        joints = [self.platform[k] + plane_vectors(errors, "plat", k + 1, count) for k in range(3)]
        legs = [np.linalg.norm(place + turned(self.pose["phi"], self.platform[k]) - self.base[k])
                + of(errors, f"leg_{k + 1}", count)[:, None] for k in range(3)]

        def excess(angle):
            """By how much the third joint is farther from its base joint than its leg is long [N x angles]."""
            centres = [self.base[k] - turned(angle, joints[k][:, None, :]) for k in range(3)]
            between = centres[1] - centres[0]
            distance = np.linalg.norm(between, axis=-1)
            along = (legs[0] ** 2 - legs[1] ** 2 + distance ** 2) / (2.0 * distance)
            across = np.sqrt(np.maximum(legs[0] ** 2 - along ** 2, 0.0))
            unit = between / distance[..., None]
            square = np.stack([-unit[..., 1], unit[..., 0]], -1)
            # Of the two places the one on the side where the nominal place is.
            side = np.sign(np.sum((place - centres[0]) * square, axis=-1))
            found = centres[0] + along[..., None] * unit + (side * across)[..., None] * square
            return np.linalg.norm(found - centres[2], axis=-1) - legs[2]

        low = np.full(count, self.pose["phi"] - np.radians(20.0))
        high = np.full(count, self.pose["phi"] + np.radians(5.0))
        for _ in range(6):
            angles = np.linspace(low, high, 41, axis=-1)
            least = np.argmin(excess(angles), axis=-1)
            low = angles[np.arange(count), np.maximum(least - 1, 0)]
            high = angles[np.arange(count), np.minimum(least + 1, 40)]
        return -excess(np.linspace(low, high, 41, axis=-1)).min(axis=-1)


class FlatDelta:
    """Three spheres about the carriages, shifted by the platform's joints, have a point in common, or none."""

    file = "flat-delta.toml"
    pose = {"x": 0.0, "y": 0.0, "z": 0.2}
    lengths = [f"{name}_{k}" for name in ("zero", "rod") for k in (1, 2, 3)]

    def margins(self, errors, count):
        angles = 2.0 * np.pi * np.arange(3) / 3.0
        centres = np.stack([np.stack(np.broadcast_arrays(0.16 * np.cos(a), 0.16 * np.sin(a),
                                                         0.205 + of(errors, f"zero_{k + 1}", count)), -1)
                            for k, a in enumerate(angles)], 1)
        rods = np.hypot(0.16, 0.005) + np.stack([of(errors, f"rod_{k}", count) for k in (1, 2, 3)], -1)
        # The foot of the platform on the plane of the centres.
        edges = centres[:, 1:] - centres[:, :1]
        right = 0.5 * (np.sum(edges ** 2, axis=-1) - rods[:, 1:] ** 2 + rods[:, :1] ** 2)
        gram = edges @ edges.transpose(0, 2, 1)
        foot = np.linalg.solve(gram, right[..., None])[..., 0][:, None, :] @ edges
        return rods[:, 0] - np.linalg.norm(foot[:, 0], axis=-1)


MECHANISMS = [FiveBar(), ThreeRpr(), FlatDelta()]
