"""`poesy evaluate` reproduces independently computed reference cases, and a study has the published symmetries."""

import json
import os

import h5py
import numpy as np

from poesy_program import STUDY, ProgramTest, main

COORDINATES = ["z", "beta", "gamma"]


class Oracle(ProgramTest):
    def test_every_converged_case(self):
        with open(os.environ["POESY_ORACLE"], encoding="utf-8") as file:
            cases = [case for case in json.load(file)["cases"] if case["converged"]]
        self.assertGreater(len(cases), 10)
        factors = sorted({name for case in cases for name in case["errors"]})
        rows = [",".join(repr(case["pose"][name]) for name in COORDINATES) for case in cases]
        self.write("poses.csv", "\n".join([",".join(COORDINATES), *rows]) + "\n")
        rows = [",".join(repr(case["errors"].get(name, 0.0)) for name in factors) for case in cases]
        self.write("errors.csv", "\n".join([",".join(factors), *rows]) + "\n")
        self.write("study.toml", STUDY)
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--paired", "-o", "out.h5")
        with h5py.File(self.folder / "out.h5") as result:
            group = result["evaluate"]
            for m, case in enumerate(cases):
                np.testing.assert_allclose(group["joint_displacements"][m], np.ravel(case["joint_displacements"]), rtol=0, atol=1e-12)
                for name in ("delta_mu_21", "delta_mu_32", "delta_mu_13"):
                    np.testing.assert_allclose(group[name][m, 0], case[name], rtol=0, atol=1e-11)
                self.assertAlmostEqual(group["deformation_max"][m, 0], case["delta_mu_max"], delta=1e-11)
                self.assertAlmostEqual(group["angular_deformation"][m, 0], case["angular_deformation"], delta=1e-11)
                self.assertAlmostEqual(group["linear_deformation"][m, 0], case["linear_deformation"], delta=1e-11)

    def test_published_symmetries(self):
        # Du et al. 2022, Section 6.2 and Table 10.
        equal = ["delta_1_1_y", "delta_1_2_z", "delta_1_3_x", "delta_1_4_y"]
        names = [*equal, "epsilon_1_1_z"]
        study = STUDY.replace('["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]', json.dumps(names))
        study = study.replace('"0.2 deg"', '"1 deg"').replace("count = 6", "count = 20")
        self.write("study.toml", study)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        with h5py.File(self.folder / "out.h5") as result:
            responses = [name.decode() for name in result["responses/name"]]
            linear, angular = responses.index("linear_deformation"), responses.index("angular_deformation")
            low = result["sensitivity/global_ci_low"][linear]
            high = result["sensitivity/global_ci_high"][linear]
            angular_indices = result["sensitivity/global"][angular]
        for i in range(4):
            for j in range(4):
                self.assertLessEqual(low[i], high[j], (names[i], names[j]))
        # 1 deg of epsilon_1_1_z has the effect of pi/180 mm of delta_1_1_y, so 1 rad has that of 1e-3 m.
        self.assertLessEqual(low[4] / 1e-3, high[0])
        self.assertLessEqual(low[0], high[4] / 1e-3)
        self.assertLess(np.max(angular_indices), 1e-10)


if __name__ == "__main__":
    main()
