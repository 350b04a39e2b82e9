"""The source of the package: types, docstrings, and no import that is not needed to read a result.

mypy checks the types if it is installed.
"""

import ast
import importlib.util
import inspect
import subprocess
import sys
import tempfile
import unittest

from package import PROGRAM, ROOT, main, poesy

PACKAGE = ROOT / "engine" / "python"
SOURCES = sorted((PACKAGE / "poesy").glob("*.py"))


class Source(unittest.TestCase):
    def test_types(self):
        if importlib.util.find_spec("mypy") is None:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as cache:
            command = [sys.executable, "-B", "-m", "mypy", "--cache-dir", cache]
            done = subprocess.run(command, cwd=PACKAGE, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_every_function_has_types(self):
        for path in SOURCES:
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.FunctionDef):
                    arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                    bare = [one.arg for one in arguments if one.annotation is None and one.arg not in ("self", "_")]
                    self.assertEqual((bare, node.returns is None), ([], False), f"{path.name}:{node.name}")

    def test_public_names_have_docstrings(self):
        for name in poesy.__all__:
            thing = getattr(poesy, name)
            self.assertTrue(inspect.getdoc(thing), name)
            if inspect.isclass(thing):
                for method, function in vars(thing).items():
                    if not method.startswith("_") and (inspect.isfunction(function) or isinstance(function, property)):
                        self.assertTrue(inspect.getdoc(function), f"{name}.{method}")

    def test_functions_and_lines_are_short(self):
        for path in SOURCES:
            text = path.read_text(encoding="utf-8")
            for node in ast.walk(ast.parse(text)):
                if isinstance(node, ast.FunctionDef):
                    doc = ast.get_docstring(node, clean=False) or ""
                    self.assertLess(node.end_lineno - node.lineno - doc.count("\n"), 60, f"{path.name}:{node.name}")
            for number, line in enumerate(text.splitlines(), start=1):
                self.assertLessEqual(len(line), 130, f"{path.name}:{number}")

    def test_pictures_are_not_needed_to_read(self):
        code = "import sys; sys.modules['matplotlib'] = None; import poesy; print(poesy.program_version()['version'])"
        done = subprocess.run(
            [sys.executable, "-B", "-c", code], capture_output=True, text=True, check=False,
            env={"PYTHONPATH": str(PACKAGE), "POESY": PROGRAM},
        )  # fmt: skip
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_version_is_the_projects(self):
        project = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        self.assertIn(f"project(poesy VERSION {poesy.__version__} ", project)
        self.assertIn('version = { attr = "poesy.__version__" }', (PACKAGE / "pyproject.toml").read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
