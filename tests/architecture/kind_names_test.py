#!/usr/bin/env python3
"""Plants violations in a small tree: kind_names.py must find each of them, and nothing in the clean tree."""

import tempfile
import unittest
from pathlib import Path

import kind_names

CLEAN = {
    "engine/kinds/registry.cpp": '#include "engine/kinds/two_ways/kind.h"\n#include "engine/kinds/evaluate/kind.h"\n',
    "engine/kinds/two_ways/kind.h": '#include "engine/kinds/two_ways/keys.h"\nconst char* name = "two-ways";\n',
    "engine/kinds/evaluate/kind.h": '#include "engine/run/fold.h"\n',
    "engine/run/fold.h": '// as in two ways\nvoid evaluate();  /* two-ways\n two ways */ const char* web = "http://x";\n',
    "engine/app/help.cpp": 'const char* example = "poesy template MODEL two-ways";\n',
    "engine/run/words.cpp": 'const char* remedy = "write a study of kind two-ways";\n',
    "engine/app/evaluate.cpp": 'const char* command = "evaluate";\n',
}


def problems(planted):
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in (CLEAN | planted).items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return kind_names.problems(root)


class KindNamesTest(unittest.TestCase):
    def expect_one(self, file, text, place, words):
        found = problems({file: text})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(place), found)
        self.assertIn(words, found[0])

    def test_clean_tree_has_no_problem(self):
        self.assertEqual(problems({}), [])

    def test_room_names_a_kind(self):
        for text in ("void run_two_ways();", "struct TwoWays;", 'x == "two-ways"', '#include "engine/kinds/two_ways/a.h"'):
            self.expect_one("engine/run/a.h", "\n" + text, "engine/run/a.h:2: ", "names the kind of study 'two_ways'")

    def test_room_compares_with_a_word_that_means_more(self):
        self.expect_one("engine/report/a.cpp", 'kind == "evaluate"', "engine/report/a.cpp:1: ", "'evaluate'")

    def test_program_compares_with_a_name(self):
        self.expect_one("engine/app/show.cpp", 'kind == "two-ways"', "engine/app/show.cpp:1: ", "'two_ways'")

    def test_program_includes_a_kind(self):
        self.expect_one("engine/app/show.cpp", '#include "engine/kinds/two_ways/a.h"', "engine/app/show.cpp:1: ",
                        "'two_ways'")

    def test_what_kinds_share_names_one(self):
        self.expect_one("engine/kinds/kind.h", "struct TwoWays;", "engine/kinds/kind.h:1: ", "'two_ways'")

    def test_kind_includes_another(self):
        self.expect_one("engine/kinds/evaluate/a.h", '#include "engine/kinds/two_ways/keys.h"',
                        "engine/kinds/evaluate/a.h:1: ", "includes the kind 'two_ways'")

    def test_registry_without_kinds(self):
        self.expect_one("engine/kinds/registry.cpp", "", "engine/kinds/registry.cpp: ", "includes no kind")


if __name__ == "__main__":
    unittest.main()
