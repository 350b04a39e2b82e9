"""Checks the example results of tests/engine/kinds/example_result.h: names, units and every value, with h5py and xarray.

usage: check_values.py SENSITIVITY.h5 EVALUATE.h5 PAIRED.h5
"""

import sys

import h5py
import numpy as np
import xarray

RESPONSES = ["angular_deformation", "linear_deformation"]
FACTORS = ["epsilon_1", "delta_1"]
STATUS = ["converged", "stagnated", "iteration_cap", "singular", "non_finite"]


def expect(found, expected):
    np.testing.assert_array_equal(np.asarray(found), np.asarray(expected))


def opened(path, group):
    with xarray.open_dataset(path, engine="h5netcdf", group=group) as dataset:
        return dataset.load()


def numbered(array, poses):
    r, p, m = np.meshgrid([0, 1], [0, 1], np.arange(poses), indexing="ij")
    values = 1000 * array + 100 * r + 10 * p + m / 8
    values[-1, -1, -1] = np.nan
    return values


def check_tolerances(found):
    """Of the indices 5000 and 5010, 5100 and NaN; the reference is the smaller effect, at 1 mm or 1 degree."""
    expect(found.coords["response"], RESPONSES)
    expect(found.coords["factor"], FACTORS)
    expect(found["kind"], ["angular", "linear"])
    expect(found["limb"], [1, 1])
    expect(found["unit"], ["rad", "m"])
    expect(found["index"], [[5000, 5010], [5100, np.nan]])
    expect(found["index_ci_low"], [[6000, 6010], [6100, np.nan]])
    expect(found["index_ci_high"], [[7000, 7010], [7100, np.nan]])
    expect(found["reference_factor"], ["delta_1", "epsilon_1"])
    degree = np.pi / 180
    np.testing.assert_allclose(found["reference_tolerance"], [0.001, degree], rtol=1e-15)
    np.testing.assert_allclose(found["equal_effect"], [[5.01 / 5000, 0.001], [degree, np.nan]], rtol=1e-15)
    background = np.arange(8).reshape(2, 4) / 16
    np.testing.assert_allclose(found["background_rms"], np.sqrt((background**2).mean(axis=1)), rtol=1e-15)
    square = (numbered(3, 4) ** 2 + numbered(4, 4) ** 2 * 96 / 97).mean(axis=2) - (background**2).mean(axis=1)[:, None]
    sigma = np.array([0.5 / np.sqrt(3), 0.001])
    np.testing.assert_allclose(found["rms_effect"], np.sqrt(square) / sigma, rtol=1e-12)
    shares = square / square.sum(axis=1)[:, None]
    np.testing.assert_allclose(found["mean_square_share"], shares, rtol=1e-12)
    expect(found["mean_square_bound"], [1, 1])


def check_sensitivity(path):
    found = opened(path, "sensitivity")
    expect(found.coords["response"], RESPONSES)
    expect(found.coords["factor"], FACTORS)
    expect(found.coords["pose"], [0, 1, 2, 3])
    for array, name in enumerate(["local", "local_ci_low", "local_ci_high", "mean", "std"]):
        assert found[name].dims == ("response", "factor", "pose"), name
        expect(found[name], numbered(array, 4))
    for array, name in enumerate(["global", "global_ci_low", "global_ci_high"], start=5):
        assert found[name].dims == ("response", "factor"), name
        expect(found[name], numbered(array, 1)[:, :, 0])
    for array, name in enumerate(["global_corrected", "global_corrected_ci_low", "global_corrected_ci_high"], start=11):
        assert found[name].dims == ("response", "factor"), name
        expect(found[name], numbered(array, 1)[:, :, 0])
    expect(found["rounding"], [1e-15, 2e-15])
    expect(found["index_change"], [[-0.25, 0.125], [0.0, np.nan]])
    assert found["count"].dtype.kind == "u"
    expect(found["count"], np.full((2, 2, 4), 97))
    assert found["local"].sel(response="linear_deformation", factor="epsilon_1", pose=2) == 100.25
    assert found["global"].attrs["unit"] == "SI: response unit / factor unit"
    assert found.attrs["conf_level"] == 0.95
    for name in ("global_ci_low", "global_ci_high", "global_corrected_ci_low", "global_corrected_ci_high", "local_ci_low",
                 "local_ci_high"):
        assert found[name].attrs["conf_level"] == 0.95

    assert found["background"].dims == ("response", "pose")
    expect(found["background"], np.arange(8).reshape(2, 4) / 16)

    check_tolerances(opened(path, "tolerances"))

    history = opened(path, "sensitivity/history")
    expect(history.coords["samples"], [50, 100])
    for array, name in enumerate(["global", "global_ci_low", "global_ci_high"], start=8):
        assert history[name].dims == ("response", "factor", "samples"), name
        expected = numbered(array, 2)
        if name != "global_ci_high":
            expected[-1, -1, -1] = 1000 * array + 110 + 1 / 8
        expect(history[name], expected)
    assert history["global"].sel(response="linear_deformation", factor="epsilon_1", samples=50) == 8100
    assert history.attrs["conf_level"] == history["global_ci_low"].attrs["conf_level"] == 0.95

    solver = opened(path, "solver")
    cell = np.arange(8).reshape(2, 4)
    assert solver["not_converged"].dims == ("factor", "pose")
    expect(solver["not_converged"], 3 + cell)
    expect(solver["iterations_mean"], (700 + cell) / 100)
    expect(solver["iterations_max"], np.full((2, 4), 50))
    expect(solver.coords["status"], STATUS)
    expect(solver["solves_by_status"].sel(status="converged"), 90 - cell)
    expect(solver["solves_by_status"].sel(status="non_finite"), cell)

    with h5py.File(path) as file:
        assert file.attrs["kind"] == "sensitivity"
        assert file.attrs["model"] == "fake"
        assert file.attrs["title"] == "Beispiel für Dateien"
        expect(file["factors/name"].asstr()[:], FACTORS)
        expect(file["factors/unit"].asstr()[:], ["rad", "m"])
        np.testing.assert_allclose(file["factors/sigma"][:], [0.5 / np.sqrt(3), 0.001], rtol=1e-15)
        expect(file["factors/distribution"].asstr()[:], ["uniform", "normal"])
        expect(file["responses/name"].asstr()[:], RESPONSES)
        expect(file["responses/unit"].asstr()[:], ["rad", "m"])
        expect(file["poses/z"][:], -0.25 + np.arange(4) / 64)
        expect(file["poses/gamma"][:], -np.arange(4) / 4)
        assert [file["poses"][name].attrs["unit"] for name in ("z", "beta", "gamma")] == ["m", "rad", "rad"]
        assert set(file["poses"]) == {"z", "beta", "gamma", "condition", "rejected"}
        expect(file["poses/condition"][:], [4, 4.5, 5, np.inf])
        expect(file["poses/rejected/reason"].asstr()[:], ["q_1 above 250 mm", "out of reach: z must be negative"])
        expect(file["poses/rejected/count"][:], [12, 3])


def check_evaluation(path, samples, rows_axis):
    found = opened(path, "evaluate")
    rows = 4 * samples
    expect(found.coords["pose"], np.arange(4))
    expect(found.coords["sample"], np.arange(samples))
    for r, response in enumerate(RESPONSES):
        assert found[response].dims == ("pose", "sample")
        expect(found[response], (r * rows + np.arange(rows)).reshape(4, samples) / 8)
    assert found["angular_deformation"].attrs["unit"] == "rad"
    details = np.arange(8 * rows).reshape(4, samples, 8)
    expect(found["signed"], details[:, :, 0:2])
    expect(found["twist_21"], details[:, :, 2:5])
    expect(found["twist_32"], details[:, :, 5:8])
    expect(found["twist_32"].sel(component_2="v_z"), details[:, :, 7])
    expect(found["signed"].sel(component="linear"), details[:, :, 1])
    assert found["twist_21"].attrs["unit"] == "rad,rad,m"
    expect(found["status"], (np.arange(rows) % 5).reshape(4, samples))
    expect(found["status"].attrs["status_names"], STATUS)
    expect(found["iterations"], (10 + np.arange(rows)).reshape(4, samples))
    expect(found["joint_displacements"].sel(joint="q_2"), (2 * np.arange(4) + 1) / 4)

    errors = opened(path, "errors")
    assert errors["values"].dims == (rows_axis, "factor")
    expect(errors["values"].sel(factor="epsilon_1"), (2 * np.arange(errors.dims[rows_axis]) + 1) / 1024)
    return errors.attrs["pairing"]


def main(sensitivity, evaluate, paired):
    check_sensitivity(sensitivity)
    assert check_evaluation(evaluate, 3, "sample") == "every-pose-with-every-row"
    assert check_evaluation(paired, 1, "pose") == "row-by-row"


if __name__ == "__main__":
    main(*sys.argv[1:])
