"""Independent kinematics of mechanisms in tests/data/mechanisms, in SI units. Errors are arrays [N] by name; errors
without an array are zero. `margins` of a mechanism tell which machines can be assembled at its pose: the margins (m)
of those are positive. `displacement` is that of the platform at M poses: [M x N x 6]."""

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


def foot_of_spheres(centres, radii):
    """Of the two points that three spheres have in common: the middle, which is in the plane of the centres, from the first
    centre. centres [... x 3 x 3], radii [... x 3]: [... x 3]."""
    edges = centres[..., 1:, :] - centres[..., :1, :]
    right = 0.5 * (np.sum(edges ** 2, axis=-1) - radii[..., 1:] ** 2 + radii[..., :1] ** 2)
    gram = edges @ np.swapaxes(edges, -1, -2)
    return (np.linalg.solve(gram, right[..., None])[..., 0][..., None, :] @ edges)[..., 0, :]


def three_spheres(centres, radii, near):
    """The point that three spheres have in common, on the side of their centres' plane where `near` is: [... x 3]."""
    foot = foot_of_spheres(centres, radii)
    normal = np.cross(centres[..., 1, :] - centres[..., 0, :], centres[..., 2, :] - centres[..., 0, :])
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    side = np.sign(np.sum((near - centres[..., 0, :]) * normal, axis=-1, keepdims=True))
    height = np.sqrt(radii[..., :1] ** 2 - np.sum(foot ** 2, axis=-1, keepdims=True))
    return centres[..., 0, :] + foot + side * height * normal


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
            # Of both intersections, the one on the side of the nominal place.
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
        return rods[:, 0] - np.linalg.norm(foot_of_spheres(centres, rods), axis=-1)


MECHANISMS = [FiveBar(), ThreeRpr(), FlatDelta()]


def rotations(vectors):
    """Of rotation vectors [... x 3]: [... x 3 x 3]."""
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    hat = np.moveaxis(np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]), (0, 1), (-2, -1))
    return np.eye(3) + np.sinc(angle / np.pi) * hat + 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2 * hat @ hat


def rotation_vectors(matrices):
    """Of rotations by less than a right angle [... x 3 x 3]: [... x 3]."""
    sines = 0.5 * np.stack([matrices[..., 2, 1] - matrices[..., 1, 2], matrices[..., 0, 2] - matrices[..., 2, 0],
                            matrices[..., 1, 0] - matrices[..., 0, 1]], -1)
    sine = np.linalg.norm(sines, axis=-1, keepdims=True)
    large = sine > 1e-8
    return sines * np.where(large, np.arcsin(np.minimum(sine, 1.0)) / np.where(large, sine, 1.0), 1.0)


def error_vectors(errors, names, count):
    """Of names [rows][components]: [N x rows x components]."""
    return np.moveaxis(np.array([[of(errors, name, count) for name in row] for row in names]), -1, 0)


def six_legs(ends, balls, lengths, rotation, position):
    """Where a platform is whose balls [N x 6 x 3] legs of these lengths [N x 6] hold to their ends [N x 6 x 3], by Newton's
    method from a rotation [N x 3 x 3] and a position [N x 3]: both."""
    for _ in range(6):
        found, jacobian = legs_of(ends, balls, rotation, position)
        step = np.linalg.solve(jacobian, (lengths - found)[..., None])[..., 0]
        rotation, position = rotations(step[:, :3]) @ rotation, position + step[:, 3:]
    assert np.abs(step).max() < 1e-12
    return rotation, position


def legs_of(ends, balls, rotation, position):
    """Lengths of six legs [N x 6], and their derivatives by turns and moves of the platform [N x 6 x 6]."""
    arms = np.einsum("nij,nkj->nki", rotation, balls)
    legs = arms + position[:, None] - ends
    found = np.linalg.norm(legs, axis=-1)
    along = legs / found[..., None]
    return found, np.concatenate([np.cross(arms, along), along], -1)


def followed_legs(machines, count, position, size):
    """Where a platform on six legs goes while its errors grow from none: machines(shares [N]) has its ends and balls [N x 6 x
    3] and its legs' lengths [N x 6]. A step may change the determinant of the legs' derivatives, with lengths in units of
    `size`, by a third; a machine that takes no step of 1e-10 has come to where it is zero. Machines that arrive [N], rotations
    [N x 3 x 3] and positions [N x 3]."""
    rotation, position = np.tile(np.eye(3), (count, 1, 1)), np.tile(position, (count, 1))
    unit = np.array([1.0 / size] * 3 + [1.0] * 3)
    share, step = np.zeros(count), np.full(count, 0.01)
    ends, balls, _ = machines(share)
    determinant = np.linalg.det(legs_of(ends, balls, rotation, position)[1] * unit)
    moves = np.arange(count)
    while moves.size:
        there = np.minimum(share + step, 1.0)
        ends, balls, lengths = (part[moves] for part in machines(there))
        turned, moved = rotation[moves], position[moves]
        good = np.ones(moves.size, bool)
        for n in range(5):
            found, jacobian = legs_of(ends, balls, turned, moved)
            change = np.linalg.solve(jacobian * unit, (lengths - found)[..., None])[..., 0]
            length = np.linalg.norm(change, axis=-1)
            good &= length < (0.02 * size if n == 0 else 0.005 * size)
            change = good[:, None] * unit * change
            turned, moved = rotations(change[:, :3]) @ turned, moved + change[:, 3:]
        now = np.linalg.det(legs_of(ends, balls, turned, moved)[1] * unit)
        ratio = now / determinant[moves]
        good &= (length < 1e-12) & (ratio > 2.0 / 3.0) & (ratio < 1.5)
        taken = moves[good]
        rotation[taken], position[taken], determinant[taken], share[taken] = turned[good], moved[good], now[good], there[taken]
        step[taken] *= 1.3
        step[moves[~good]] *= 0.5
        moves = moves[(share[moves] < 1.0) & (step[moves] > 1e-10)]
    return share == 1.0, rotation, position


def moved_legs(arrived, rotation, position, place):
    """What followed_legs() found, with the platform's displacement [N x 6] from a level place."""
    return arrived, np.concatenate([position - place, rotation_vectors(rotation)], -1)


class SixRods:
    """printer.toml: the effector is where its six balls are as far from those of the carriages as the rods are long. The
    first three rods are those on the left of the three carriages, the others those on the right."""

    file, coordinates = "printer.toml", ("x", "y", "z")
    rod, reach, radius, width = 0.217, 0.095, 0.030, 0.046
    sides, towers = ("left",) * 3 + ("right",) * 3, (1, 2, 3, 1, 2, 3)
    names = ([f"{name}_{axis}_{k}" for name in ("tower", "lean") for k in (1, 2, 3) for axis in "xy"]
             + [f"endstop_{k}" for k in (1, 2, 3)] + [f"rod_{side}_{k}" for side, k in zip(sides, towers)]
             + [f"ball_{side}_{axis}_{k}" for side, k in zip(sides, towers) for axis in "xyz"])

    def __init__(self):
        across = np.repeat([0.5, -0.5], 3) * self.width
        turns = np.tile(2.0 * np.pi * np.arange(3) / 3.0, 2)

        def around(radius):
            x, y = turned(turns, np.stack([np.full(6, radius), across], -1)).T
            return np.stack([x, y, np.zeros(6)], -1)

        self.up, self.down = around(self.reach + self.radius), around(self.radius)
        self.axes = np.stack([*turned(turns[:3], np.array([self.reach + self.radius, 0.0])).T, np.zeros(3)], -1)

    def heights(self, places):
        """Of the three carriages where the drives put them [M x 3]."""
        across = np.linalg.norm((self.up - self.down - places[:, None])[..., :2], axis=-1)[:, :3]
        return places[:, 2:] + np.sqrt(self.rod ** 2 - across ** 2)

    def put(self, errors, count, points, towers, heights):
        """Points on carriages at `heights` [M x points], with the errors of their towers: points [M x N x points x 3], and
        how the towers lean [N x points x 3 x 3]."""
        place = points + np.array([0.0, 0.0, 1.0]) * heights[:, None, :, None]
        raised = place + error_vectors(errors, [["", "", f"endstop_{k}"] for k in towers], count)
        leaning = rotations(error_vectors(errors, [[f"lean_x_{k}", f"lean_y_{k}", ""] for k in towers], count))
        moved = error_vectors(errors, [[f"tower_x_{k}", f"tower_y_{k}", ""] for k in towers], count)
        return (leaning @ raised[..., None])[..., 0] + moved, leaning

    def carriages(self, errors, places):
        """How far their origins have moved [M x N x 3 x 3], and how they are turned [N x 3 x 3], as vectors."""
        count = len(next(iter(errors.values())))
        heights = self.heights(places)
        there, leaning = self.put(errors, count, self.axes, (1, 2, 3), heights)
        nominal, _ = self.put({}, 1, self.axes, (1, 2, 3), heights)
        return there - nominal, rotation_vectors(leaning)

    def followed(self, errors, place):
        """Machines that can be assembled near a place [N], and where their effectors are [N x 6]; see followed_legs()."""
        count = len(next(iter(errors.values())))
        pairs = list(zip(self.sides, self.towers))
        rods = error_vectors(errors, [[f"rod_{side}_{k}" for side, k in pairs]], count)[:, 0]
        seats = error_vectors(errors, [[f"ball_{side}_{axis}_{k}" for axis in "xyz"] for side, k in pairs], count)

        def machines(shares):
            grown = {name: shares * values for name, values in errors.items()}
            ends, _ = self.put(grown, count, self.up, self.towers, np.tile(self.heights(place[None]), 2))
            return ends[0], self.down + shares[:, None, None] * seats, self.rod + shares[:, None] * rods

        return moved_legs(*followed_legs(machines, count, place, self.rod), place)

    def displacement(self, errors, places):
        """Of the effector, x y z and its rotation vector: [M x N x 6]."""
        count = len(next(iter(errors.values())))
        ends, _ = self.put(errors, count, self.up, self.towers, np.tile(self.heights(places), 2))
        ends = ends.reshape(-1, 6, 3)
        pairs = list(zip(self.sides, self.towers))
        rods = self.rod + error_vectors(errors, [[f"rod_{side}_{k}" for side, k in pairs]], count)[:, 0]
        seats = error_vectors(errors, [[f"ball_{side}_{axis}_{k}" for axis in "xyz"] for side, k in pairs], count)
        rods, balls = np.tile(rods, (len(places), 1)), np.tile(self.down + seats, (len(places), 1, 1))
        rotation, position = np.tile(np.eye(3), (len(ends), 1, 1)), np.repeat(places, count, axis=0)
        rotation, position = six_legs(ends, balls, rods, rotation, position)
        moved = np.concatenate([position - np.repeat(places, count, axis=0), rotation_vectors(rotation)], -1)
        return moved.reshape(len(places), count, 6)


class SixLegs:
    """ups6.toml: each leg leads from a point of the base to one of the platform. It has errors of both and of its length."""

    file, coordinates = "ups6.toml", ("x", "y", "z", "rx", "ry", "rz")
    ends = 1e-3 * np.array([[305.4001, 111.1565, 0.0], [-56.4357, 320.0625, 0.0], [-248.9644, 208.906, 0.0],
                            [-248.9644, -208.906, 0.0], [-56.4357, -320.0625, 0.0], [305.4001, -111.1565, 0.0]])
    balls = 1e-3 * np.array([[92.1597, 84.4488, 0.0], [27.055, 122.037, 0.0], [-119.2146, 37.58822, 0.0],
                             [-119.2146, -37.5882, 0.0], [27.055, -122.037, 0.0], [92.1597, -84.4488, 0.0]])
    names = [f"delta_{k}_{frame}_{axis}" for k in range(1, 7) for frame in (0, 6) for axis in "xyz"] + [
        f"delta_{k}_3_z" for k in range(1, 7)]

    def followed(self, errors, place):
        """Of level platforms, as SixRods.followed()."""
        count = len(next(iter(errors.values())))
        at_base, at_platform = (error_vectors(errors, [[f"delta_{k}_{frame}_{axis}" for axis in "xyz"] for k in range(1, 7)],
                                              count) for frame in (0, 6))
        longer = error_vectors(errors, [[f"delta_{k}_3_z" for k in range(1, 7)]], count)[:, 0]
        nominal = np.linalg.norm(self.balls + place - self.ends, axis=-1)

        def machines(shares):
            of_each = shares[:, None, None]
            return self.ends + of_each * at_base, self.balls + of_each * at_platform, nominal + shares[:, None] * longer

        return moved_legs(*followed_legs(machines, count, place, 0.15), place)


class BellCrank:
    """bell-crank.toml: crank and effector are where circles about the rods' ends meet. Complex numbers are points."""

    names = ["arm_x", "arm_y", "forearm", "lower_rod", "lower_across", "upper_rod", "upper_across", "pin_x", "pin_y"]
    arm, forearm, short = 0.040, 0.060, 0.010
    low, high = 0.010 * np.exp(1j * np.radians(195.0)), 0.010 * np.exp(1j * np.radians(75.0))  # the pins at home (m)

    def wrist(self, angles):
        point = self.arm * np.exp(1j * angles[:, 0]) + self.forearm * np.exp(1j * angles[:, 1])
        return np.stack([point.real, point.imag], -1)

    @staticmethod
    def angle(pin, centre, end, rod, near):
        """How a part on `centre` is turned whose `pin` a rod holds at a distance from `end`: the one near `near`."""
        towards = end - centre
        reach, radius = np.abs(towards), np.abs(pin)
        opening = np.arccos((radius ** 2 + reach ** 2 - rod ** 2) / (2.0 * radius * reach))
        ways = [np.angle(towards / pin * np.exp(1j * (side * opening - near))) for side in (1.0, -1.0)]
        return near + np.where(np.abs(ways[0]) < np.abs(ways[1]), ways[0], ways[1])

    def displacement(self, errors, angles):
        """[M x N x 6]"""
        count = len(next(iter(errors.values())))
        e = {name: of(errors, name, count) for name in self.names}
        found = []
        for first, second in angles:
            elbow = (self.arm + e["arm_x"] + 1j * e["arm_y"]) * np.exp(1j * first)
            # Errors of the arm do not change the direction of the forearm.
            wrist = elbow + (self.forearm + e["forearm"]) * np.exp(1j * second)
            pin = self.low + e["pin_x"] + 1j * e["pin_y"]
            crank = self.angle(pin, elbow, self.low, np.hypot(self.arm + e["lower_rod"], e["lower_across"]), 0.0)
            effector = self.angle(self.high, wrist, elbow + self.high * np.exp(1j * crank),
                                  np.hypot(self.forearm + e["upper_rod"], e["upper_across"]), crank)
            moved = wrist - self.arm * np.exp(1j * first) - self.forearm * np.exp(1j * second)
            zero = np.zeros(count)
            found.append(np.stack([moved.real, moved.imag, zero, zero, zero, effector], -1))
        return np.array(found)
