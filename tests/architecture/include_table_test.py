#!/usr/bin/env python3
"""Plants violations in a small tree: include_table.py must find each of them, and nothing in the clean tree."""

import tempfile
import unittest
from pathlib import Path

import include_table

CLEAN = {
    "engine/README.md": """# The engine

## Who may include whom

| room | may include | libraries |
|---|---|---|
| `engine/base` | - | Eigen |
| `engine/run` | `engine/base` | oneTBB in `runner.cpp` |
| `engine/storage` | `engine/base`, `engine/run/result.h` | HDF5 in `h5.*`, files |
| `models/two_legs` | `engine/base` | Eigen |
| `models` | `engine/base`, `models/two_legs` | - |
| `engine/app` | everything | CLI11 |
| `tests` | everything | everything |

## Another section

| `nonsense` | `row` | that is not of the table |
""",
    "engine/base/index.h": "#include <cstddef>\n#include <Eigen/Core>\n",
    "engine/run/result.h": '#include "engine/base/index.h"\n',
    "engine/run/runner.h": '#include "engine/run/result.h"\n',
    "engine/run/runner.cpp": '#include <tbb/task_arena.h>\n#include "engine/run/runner.h"\n',
    "engine/storage/h5.cpp": '#include <hdf5.h>\n#include <fstream>\n#include "engine/run/result.h"\n',
    "engine/app/main.cpp": '#include <CLI/CLI.hpp>\n#include "models/registry.h"\n',
    "models/registry.h": "",
    "models/registry.cpp": '#include "models/two_legs/model.h"\n',
    "models/two_legs/model.h": '#include "engine/base/index.h"\n',
    "tests/run_test.cpp": '#include <gtest/gtest.h>\n#include "helpers.h"\n#include "engine/run/runner.h"\n',
}


def problems(planted):
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in (CLEAN | planted).items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return include_table.problems(root)


class IncludeTableTest(unittest.TestCase):
    def expect_one(self, file, text, place, words):
        found = problems({file: text})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(place), found)
        self.assertIn(words, found[0])

    def expect_table_error(self, old, new, words):
        text = CLEAN["engine/README.md"].replace(old, new)
        self.assertNotEqual(text, CLEAN["engine/README.md"])
        self.expect_one("engine/README.md", text, "engine/README.md: ", words)

    def test_clean_tree_has_no_problem(self):
        self.assertEqual(problems({}), [])

    def test_room_above_includes_room_below(self):
        self.expect_one("engine/base/units.cpp", '\n#include "engine/run/result.h"\n', "engine/base/units.cpp:2: ",
                        "engine/base may not include engine/run")

    def test_engine_includes_a_model(self):
        self.expect_one("engine/storage/file.cpp", '#include "models/registry.h"\n', "engine/storage/file.cpp:1: ",
                        "engine/storage may not include models")

    def test_only_the_named_header_of_a_room_is_open(self):
        self.expect_one("engine/storage/file.h", '#include "engine/run/runner.h"\n', "engine/storage/file.h:1: ",
                        "engine/storage may not include engine/run")

    def test_library_in_another_file_than_the_table_says(self):
        self.expect_one("engine/run/result.cpp", "#  include <tbb/parallel_for.h>\n", "engine/run/result.cpp:1: ",
                        "oneTBB (<tbb/parallel_for.h>) belongs in runner.cpp")

    def test_decomposition_in_a_room_that_has_eigen(self):
        self.expect_one("engine/base/solve.cpp", "#include <Eigen/LU>\n", "engine/base/solve.cpp:1: ", "decompositions")

    def test_library_that_the_room_may_not_use(self):
        self.expect_one("models/two_legs/model.cpp", "#include <hdf5.h>\n", "models/two_legs/model.cpp:1: ",
                        "models/two_legs may not include HDF5")

    def test_part_of_the_standard_library_that_is_kept_apart(self):
        for header in ("thread", "random", "fstream", "iostream", "unistd.h"):
            self.expect_one("models/two_legs/model.cpp", f"#include <{header}>\n", "models/two_legs/model.cpp:1: ",
                            "models/two_legs may not include")

    def test_unknown_library(self):
        self.expect_one("engine/base/json.h", "#include <rapidjson/document.h>\n", "engine/base/json.h:1: ",
                        "belongs to no known library")

    def test_relative_include(self):
        self.expect_one("engine/run/a.cpp", '#include "result.h"\n', "engine/run/a.cpp:1: ", "is in no room")

    def test_file_outside_all_rooms(self):
        self.expect_one("engine/extra/a.h", "", "engine/extra/a.h:1: ", "is in no room")

    def test_engine_names_a_mechanism(self):
        for name in ("two_legs", "2LEGS", "Two-Legs", "2-legs"):
            self.expect_one("engine/base/a.h", f"// as in {name}\n", "engine/base/a.h:1: ", "names the mechanism")

    def test_program_may_name_a_mechanism(self):
        self.assertEqual(problems({"engine/app/models.cpp": "// poesy models two-legs\n"}), [])

    def test_registry_without_mechanisms(self):
        self.expect_one("models/registry.cpp", "", "engine/README.md: ", "includes no mechanism")

    def test_table_that_points_up(self):
        self.expect_table_error("| `engine/base` | -", "| `engine/base` | `engine/run`", "does not stand above it")

    def test_table_with_an_unknown_library(self):
        self.expect_table_error("| CLI11 |", "| CLI12 |", "unknown library 'CLI12'")

    def test_table_with_a_room_that_is_gone(self):
        self.expect_table_error("| `models` |", "| `gone` | - | - |\n| `models` |", "room gone has no folder")

    def test_missing_table(self):
        self.expect_table_error("## Who may include whom", "## Who", "no section")


if __name__ == "__main__":
    unittest.main()
