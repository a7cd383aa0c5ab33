"""The examples of CONTRIBUTING.md, built from its text."""

import json
import pathlib
import re
import shlex
import subprocess

from conftest import BUILD

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = "common/schemes/table.cpp"


def section(title):
    text = (ROOT / "CONTRIBUTING.md").read_text()
    return re.search(rf"^## {title}\n(.*?)^## ", text, re.M | re.S)[1]


def code_blocks(text):
    return re.findall(r"^```cpp\n(.*?)^```", text, re.M | re.S)


def compile_as(source, like, output):
    """Compiles a file with the flags of one of the project's."""
    commands = json.loads((BUILD / "compile_commands.json").read_text())
    entry = next(c for c in commands if c["file"] == str(ROOT / like))
    words = shlex.split(entry["command"])
    words[words.index("-o") + 1] = str(output)
    words[words.index("-c") + 1] = str(source)
    subprocess.run(words, cwd=entry["directory"], check=True)


def test_adding_a_scheme(tmp_path):
    scheme, declaration, row = code_blocks(section("Adding a scheme"))
    (tmp_path / "parent.cpp").write_text(scheme)
    table = (ROOT / TABLE).read_text()
    table = re.sub(r"((^SchemeRow \w+_scheme\(\);.*\n)+)", lambda m: m[1] + declaration, table, count=1, flags=re.M)
    table = table.replace("    };\n    return all;", row + "    };\n    return all;")
    assert declaration in table and row in table
    (tmp_path / "table.cpp").write_text(table)
    for name in ("parent", "table"):
        compile_as(tmp_path / f"{name}.cpp", TABLE, tmp_path / f"{name}.o")
    tests = BUILD / "tests/CMakeFiles/multires_unit_tests.dir/unit"
    subprocess.run(["c++", "-o", tmp_path / "tests", tmp_path / "parent.o", tmp_path / "table.o",
                    tests / "scheme_test.cpp.o", BUILD / "meshes/libmultires_shapes.a", BUILD / "libmultires_common.a",
                    "-lgtest_main", "-lgtest", "-lpthread"], check=True)
    done = subprocess.run([tmp_path / "tests", "--gtest_brief=1"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert "PASSED" in done.stdout
    # And it is really in the table that they run on.
    listed = subprocess.run(["grep", "-c", "Parent", tmp_path / "tests"], capture_output=True, text=True)
    assert int(listed.stdout) > 0
