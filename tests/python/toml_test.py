"""TOML that the package writes is read by the standard library as the same values."""

import random
import string
import tomllib
import unittest

import numpy as np
from package import main, poesy

from poesy import _toml


class Writer(unittest.TestCase):
    def check(self, table):
        self.assertEqual(tomllib.loads(_toml.dumps(table)), table)

    def test_tables_and_lists(self):
        self.check({})
        self.check({"a": 1, "b": {"c": 2.5, "d": {}}, "e": True, "f": [], "g": [[1, 2], [3]]})
        joints = [{"name": "A", "at": ["a", 0, 0]}, {"name": "q", "actuated": True}]
        self.check({"limb": [{"copies": {"count": 3}, "joints": joints}, {}]})
        self.check({"mixed": [{"a": 1}, 2], "nested": [[{"a": {"b": 1}}]]})

    def test_values_come_before_the_tables_of_their_table(self):
        self.check({"a": {"b": 1}, "c": 2, "d": [{"e": {"f": 1}, "g": 2}], "h": 3})

    def test_texts_and_keys(self):
        self.check({"µm °": 'a "b" \\ c\n\t\r\x00\x1f\x7f', "": "empty"})
        self.check({"delta_1_4_*": ["€", "𝛿"], "a.b": {"c d": {'"': 1}}})

    def test_numbers(self):
        self.check({"a": [0, -1, 2**62, 1e-30, -0.0, 1e16, 5e-324, 1.7976931348623157e308, 0.1 + 0.2]})
        self.check({"a": [float("inf"), float("-inf")]})
        self.assertIn("nan", _toml.dumps({"a": float("nan")}))

    def test_numpy(self):
        table = {"a": np.float64(0.1), "b": np.int32(3), "c": np.bool_(True), "d": np.arange(4).reshape(2, 2), "e": np.str_("x")}
        expected = {"a": 0.1, "b": 3, "c": True, "d": [[0, 1], [2, 3]], "e": "x"}
        self.assertEqual(tomllib.loads(_toml.dumps(table)), expected)
        self.check({"tuple": [1, 2]})
        self.assertEqual(_toml.dumps({"tuple": (1, 2)}), _toml.dumps({"tuple": [1, 2]}))

    def test_random_tables(self):
        source = random.Random(19)

        def text():
            return "".join(source.choices(string.printable + "äß€", k=source.randrange(6)))

        def value(depth):
            kind = source.randrange(7 if depth < 4 else 4)
            if kind == 0:
                return source.choice([True, False])
            if kind == 1:
                return source.randrange(-(10**9), 10**9)
            if kind == 2:
                return source.uniform(-1, 1) * 10 ** source.randrange(-20, 20)
            if kind == 3:
                return text()
            if kind == 4:
                return [value(depth + 1) for _ in range(source.randrange(4))]
            return {text(): value(depth + 1) for _ in range(source.randrange(4))}

        for _ in range(300):
            self.check({str(key): value(0) for key in range(4)})

    def test_what_toml_cannot_hold(self):
        for table, words in (
            ({"analysis": {"samples": None}}, "analysis.samples is None"),
            ({"a": {1: 2}}, "the key 1 in a is not a text"),
            ({"a": [1, {2, 3}]}, "a is {2, 3}"),
            ({"a": 1j}, "a is 1j"),
        ):
            with self.assertRaisesRegex(poesy.StudyError, words):
                _toml.dumps(table)


if __name__ == "__main__":
    main()
