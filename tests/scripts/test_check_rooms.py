"""scripts/check_rooms.py itself: what it must refuse, each in a source tree of one file or two."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).resolve().parents[2] / "scripts/check_rooms.py"


def said_of(files):
    """Exit code and output for a tree with these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, CHECK, folder], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


class CheckRooms(unittest.TestCase):
    def refused(self, name, line, why):
        code, said = said_of({name: f"#pragma once\n{line}\n"})
        self.assertEqual(code, 1, said)
        self.assertIn(f"{name}:2: {line}", said)
        self.assertIn(why, said)

    def test_includes_that_point_down_pass(self):
        code, said = said_of(
            {
                "common/pyramid/a.h": '#include "schemes/scheme.h"\n#include "pyramid/b.h"\n#include <vector>\n',
                "common/vcg/a.h": "#include <vcg/complex/complex.h>\n",
                "plugins/host/a.cpp": '#include <QObject>\n#include <common/plugins/x.h>\n#include "shared/table.h"\n',
                "plugins/filter_multires_x/a.cpp": '#include "shared/table.h"\n#include "filters/shape/x.h"\n',
            }
        )
        self.assertEqual((code, said.strip()), (0, ""))

    def test_upward_include_fails(self):
        self.refused("common/mesh/a.h", '#include "pyramid/pyramid.h"', "may not look up or sideways")

    def test_include_across_the_floor_fails(self):
        self.refused("common/measure/a.cpp", '#include "normals/spikes.h"', "may not look up or sideways")

    def test_library_that_includes_plugins_fails(self):
        self.refused("common/filters/a.cpp", '#include "shared/table.h"', "may not look up or sideways")

    def test_filters_of_one_kind_that_use_another_fail(self):
        self.refused("common/filters/shape/a.cpp", '#include "filters/layers/levels.h"', "filters of one kind")

    def test_unknown_room_fails(self):
        for name in ("common/cellar/a.h", "plugins/cellar/a.h"):
            code, said = said_of({name: ""})
            self.assertEqual(code, 1)
            self.assertIn(f"there is no room {name[:-4]}", said)

    def test_qt_or_meshlab_outside_host_fails(self):
        for line in ("#include <QString>", "#include <common/ml_document/mesh_document.h>"):
            self.refused("common/filters/a.cpp", line, "only plugins/host/ knows Qt and MeshLab")
            self.refused("plugins/filter_multires_x/a.cpp", line, "only plugins/host/ knows Qt and MeshLab")

    def test_vcglib_outside_vcg_and_host_fails(self):
        self.refused("common/mesh/a.h", "#include <vcg/space/point3.h>", "know vcglib")


if __name__ == "__main__":
    unittest.main()
