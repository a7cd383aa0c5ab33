"""scripts/setup.sh itself: what it does with the virtual environment, in a source tree that has nothing else."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SETUP = pathlib.Path(__file__).resolve().parents[2] / "scripts/setup.sh"


def program(path, *lines):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(["#!/bin/sh", *lines, ""]))
    path.chmod(0o755)


class Setup(unittest.TestCase):
    def test_requirements_that_changed_are_installed_where_the_environment_is_a_link(self):
        with tempfile.TemporaryDirectory() as folder:
            root, shared = pathlib.Path(folder, "source"), pathlib.Path(folder, "shared")
            program(root / "scripts/fetch_meshlab.sh")
            # pip would take most of the time, and is not what is looked at.
            program(root / "scripts/setup.sh")
            (root / "scripts/setup.sh").write_text(SETUP.read_text().replace(" -m venv ", " -m venv --without-pip "))
            program(shared / "bin/pip")
            program(root / "bin/dpkg-query", "printf installed")
            (root / "requirements.txt").write_text("# nothing\n")
            (root / ".venv").symlink_to(shared)
            path = f"{root / 'bin'}:{os.environ['PATH']}"
            done = subprocess.run([root / "scripts/setup.sh", "demo"], env={**os.environ, "PATH": path},
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue((root / ".venv").is_symlink())
            self.assertTrue((shared / "bin/python").exists())
            self.assertIn("requirements.txt", (shared / "installed").read_text())


if __name__ == "__main__":
    unittest.main()
