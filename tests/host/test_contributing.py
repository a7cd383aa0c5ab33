"""The examples of CONTRIBUTING.md, built from its text."""

import json
import pathlib
import re
import shlex
import subprocess
import textwrap

from conftest import BUILD

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = "common/schemes/table.cpp"


def section(title):
    text = (ROOT / "CONTRIBUTING.md").read_text()
    return re.search(rf"^## {title}\n(.*?)^## ", text, re.M | re.S)[1]


def code_blocks(text):
    return re.findall(r"^```cpp\n(.*?)^```", text, re.M | re.S)


def compile_as(source, like, output, *more):
    """Compiles a file with the flags of one of the project's."""
    commands = json.loads((BUILD / "compile_commands.json").read_text())
    entry = next(c for c in commands if c["file"] == str(ROOT / like))
    words = shlex.split(entry["command"])
    words[words.index("-o") + 1] = str(output)
    words[words.index("-c") + 1] = str(source)
    subprocess.run([*words, *more], cwd=entry["directory"], check=True)


def files_of(text):
    """Path and text of every file that the section shows whole: its path ends a line, the indented code follows."""
    shown = re.findall(r"`([\w/]+\.(?:h|cpp))`:\n\n((?:       [^\n]*\n|\n)+)", text)
    return {path: textwrap.dedent(code) for path, code in shown}


# Calls the filter of a table as a host does.
CALL = """
    #include "shapes.h"
    #include "shared/table.h"
    #include <cmath>
    using namespace multires;
    int main() {
        const plugin::Filter& filter = plugin::table().filters.at(0);
        Layer layer;
        layer.mesh = shapes::icosphere(10);
        Session session;
        const Result result = filter.call(&layer).run({layer}, session);
        const double grown = (*result.positions)[0].norm() / layer.mesh.positions[0].norm();
        return std::abs(grown - 1 - 0.01 * std::sqrt(12)) < 0.002 ? 0 : 1;  // a hundredth of the box diagonal
    }
"""


def test_adding_a_filter(tmp_path):
    files = files_of(section("Adding a filter"))
    assert [pathlib.Path(path).suffix for path in files] == [".h", ".cpp", ".cpp"]
    files["main.cpp"] = CALL
    objects = []
    for path, code in files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(code)
        if path.endswith(".cpp"):
            objects.append(tmp_path / f"{len(objects)}.o")
            compile_as(tmp_path / path, "tests/tables/list_filters.cpp", objects[-1], f"-I{tmp_path}/common")
    subprocess.run(["c++", "-o", tmp_path / "call", *objects, BUILD / "meshes/libmultires_shapes.a",
                    BUILD / "plugins-build/libmultires_shared.a", BUILD / "libmultires_common.a", "-lpthread"],
                   check=True)  # fmt: skip
    subprocess.run([tmp_path / "call"], check=True)


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
    # With the first operator: the unit tests have all of them.
    done = subprocess.run([tmp_path / "tests", "--gtest_brief=1", "--gtest_filter=Scheme.*:Scheme/SchemeWith.*/0"],
                          capture_output=True, text=True)  # fmt: skip
    assert done.returncode == 0, done.stdout
    assert "PASSED" in done.stdout
    # And it is really in the table that they run on.
    listed = subprocess.run(["grep", "-c", "Parent", tmp_path / "tests"], capture_output=True, text=True)
    assert int(listed.stdout) > 0
