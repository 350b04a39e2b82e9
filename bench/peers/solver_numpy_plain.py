#!/usr/bin/python3
"""Scheme I of Du et al. 2022 in batched NumPy as one writes it first: equation by equation on [B, ., .] arrays.

usage: solver_numpy_plain.py FOLDER [PROCESSES]

As solver_numpy.py, but every sample brings all its frames, every factor of Eq. 28 is a 4x4 matrix of its own, and J
of Eq. 43 is formed. Writes FOLDER/solver_numpy_plain.csv.
"""

import numpy as np

import solver_numpy as model


def joint_motions(limb, j, q):
    """Eqs. A2-A4 for the joints of Eq. 14."""
    g = np.tile(np.eye(4), (len(q), 1, 1))
    if j == model.ACTUATED[limb]:
        g[:, 2, 3] = q
    else:
        g[:, 0, 0] = g[:, 1, 1] = np.cos(q)
        g[:, 1, 0] = np.sin(q)
        g[:, 0, 1] = -g[:, 1, 0]
    return g


def evaluate(frames, q):
    """delta_mu [B, 18] of Eq. 41 and J [B, 18, 9] of Eq. 43. frames: [B, 3, 5, 4, 4]; q: [B, 3, 4]."""
    poses, blocks = [], []
    for i in range(3):
        g = frames[:, i, 0]
        columns = []
        for j in range(4):
            if j != model.ACTUATED[i]:
                columns.append(np.concatenate((g[:, :3, 2], np.cross(g[:, :3, 3], g[:, :3, 2])), axis=1))
            g = g @ joint_motions(i, j, q[:, i, j]) @ frames[:, i, j + 1]
        poses.append(g)
        blocks.append(np.stack(columns, axis=2))
    mu = np.concatenate([model.log(poses[k] @ np.linalg.inv(poses[i])) for k, i in model.PAIRS], axis=1)
    jacobian = np.zeros((len(q), 18, 9))
    for n, (k, i) in enumerate(model.PAIRS):
        jacobian[:, 6 * n:6 * n + 6, 3 * i:3 * i + 3] = blocks[i]
        jacobian[:, 6 * n:6 * n + 6, 3 * k:3 * k + 3] = -blocks[k]
    return mu, jacobian


def solve(pose, errors):
    """As solver_numpy.solve."""
    count = max(len(error) for error in errors.values() if error.ndim == 2)
    frames = np.empty((count, 3, 5, 4, 4))
    for (i, j), error in errors.items():
        home, delta = model.FRAMES[i][j], model.error_motion(error)
        frames[:, i, j] = home @ np.linalg.inv(delta) if j == 4 else delta @ home
    q = np.tile(model.joint_variables(*pose) - model.HOME, (count, 1, 1))
    passive = np.array([(i, j) for i in range(3) for j in range(4) if j != model.ACTUATED[i]]).T
    solved, iterations = np.zeros(count, bool), np.full(count, model.MAX_ITERATIONS)
    answer = np.empty((count, 18))
    index = np.arange(count)
    smallest, flat = np.full(count, np.inf), np.zeros(count, int)
    mu, jacobian = evaluate(frames, q)
    for iteration in range(1, model.MAX_ITERATIONS + 1):
        transposed = np.swapaxes(jacobian, 1, 2)
        dq = np.linalg.solve(transposed @ jacobian, transposed @ mu[..., None])[..., 0]  # Eq. 44
        q[:, passive[0], passive[1]] += dq
        previous = mu
        mu, jacobian = evaluate(frames, q)
        change = np.abs(mu - previous).max(axis=1)
        flat = np.where(change < smallest, 0, flat + 1)
        smallest = np.minimum(smallest, change)
        done = (change < model.TOLERANCE) | ((change <= model.ROUNDING) & (flat >= model.FLAT_ITERATIONS))
        solved[index[done]], iterations[index[done]], answer[index[done]] = True, iteration, mu[done]
        index, q, mu, jacobian, smallest, flat, frames = (
            a[~done] for a in (index, q, mu, jacobian, smallest, flat, frames))
        if not len(index):
            break
    answer[index] = mu
    return answer.reshape(-1, 3, 6), solved, iterations


if __name__ == "__main__":
    model.main(solve, "solver_numpy_plain.csv")
