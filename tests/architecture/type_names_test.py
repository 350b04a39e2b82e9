#!/usr/bin/env python3
"""Plants a second definition of a type: type_names.py must find it, and nothing if all names differ."""

import tempfile
import unittest
from pathlib import Path

import type_names

FIRST = "namespace poesy {\n\nstruct Box {\n  int a;\n};\n\n}  // namespace poesy\n"
HIDDEN = "namespace poesy {\nnamespace {\n\nstruct Box {\n};\n\n}  // namespace\n}  // namespace poesy\n"


class TypeNamesTest(unittest.TestCase):
    def found(self, second):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for room, text in (("engine", FIRST), ("models", second)):
                (root / room).mkdir()
                (root / room / "box.h").write_text(text)
            return list(type_names.problems(root))

    def test_same_name(self):
        second = FIRST.replace("struct Box", "class Box final : public Container")
        self.assertEqual(len(self.found(second)), 1)
        self.assertIn("poesy::Box is defined in engine/box.h and in models/box.h", self.found(second)[0])

    def test_names_of_their_own(self):
        for second in (FIRST.replace("poesy", "poesy::simd"), FIRST.replace("Box {", "Box;"), HIDDEN,
                       FIRST.replace("struct Box {", "struct Box::State {"), "struct Box {\n};\n",
                       FIRST.replace("struct Box {", "enum class Kind { box };\nenum class Colour {")):
            self.assertEqual(self.found(second), [])


if __name__ == "__main__":
    unittest.main()
