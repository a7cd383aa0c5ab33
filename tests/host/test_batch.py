"""python -m pymeshlab_multires: chains of filters over many files, in processes that die and clusters that lose workers."""

import csv
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pymeshlab
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def vertices(path):
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(path))
    return ms.current_mesh().vertex_matrix()


@pytest.fixture(scope="module")
def sphere(tmp_path_factory):
    """A mesh that takes a filter about a second."""
    path = tmp_path_factory.mktemp("sphere") / "sphere.ply"
    ms = pymeshlab.MeshSet(verbose=False)
    ms.create_sphere(subdiv=6)
    ms.save_current_mesh(str(path))
    return path


@pytest.fixture
def run(multires):
    """run(words...): the records, without the detour over another process."""
    from pymeshlab_multires.batch import arguments
    from pymeshlab_multires.batch import run as runner

    return lambda *words: runner.run(arguments.batch([*map(str, words), "--quiet"]))


@pytest.fixture
def command(multires):
    environment = os.environ | {"PYTHONPATH": str(pathlib.Path(multires.__file__).parents[1])}

    def start(*words):
        return subprocess.Popen([sys.executable, "-m", "pymeshlab_multires", *map(str, words)], env=environment,
                                text=True, stderr=subprocess.PIPE)  # fmt: skip

    return start


def rows(table):
    with open(table, newline="") as file:
        return list(csv.DictReader(file))


def soon(found, seconds=30):
    """What found() returns as soon as that is something."""
    deadline = time.monotonic() + seconds
    while not (result := found()):
        if time.monotonic() > deadline:
            raise TimeoutError
        time.sleep(0.01)
    return result


def several(folder, source, count):
    folder.mkdir()
    for i in range(count):
        (folder / f"m{i}.ply").write_bytes(source.read_bytes())
    return folder


def leftovers(folder):
    return [path for path in folder.rglob("*") if path.name.startswith(".")]


def children():
    """Processes of meshes that this one has started."""
    found = []
    for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(status.read_text().rpartition(")")[2].split()[1])
            serves = b"serve()" in (status.parent / "cmdline").read_bytes()
        except OSError:  # gone
            continue
        if parent == os.getpid() and serves:
            found.append(int(status.parent.name))
    return found


def test_each_file_becomes_what_the_filters_make_of_it(multires, meshes, command, tmp_path):
    (tmp_path / "in/deep").mkdir(parents=True)
    ms = pymeshlab.MeshSet(verbose=False)
    for name, place in (("terrain", "in/a.ply"), ("irregular_sphere", "in/deep/b.obj")):
        ms.load_new_mesh(str(meshes / f"{name}.ply"))
        ms.save_current_mesh(str(tmp_path / place))
    (tmp_path / "in/broken.ply").write_text("ply\nformat ascii 1.0\nelement vertex many\n")
    chain = ("denoise", "strength=2", "low_pass", "unit=wavelength percent", "cutoff=10", "scheme=Roy", "denoise")
    done = command(*chain, tmp_path / "in/**/*.*", tmp_path / "in/missing.ply", "-o", tmp_path / "out", "-j", "2")
    _, said = done.communicate(timeout=60)
    assert done.returncode == 1, said
    assert "4 meshes, 2 failed" in said and "4 of 4, 2 failed" in said
    table = {pathlib.Path(row["input"]).name: row for row in rows(tmp_path / "out/reports.csv")}
    for place in ("a.ply", "deep/b.obj"):
        ms.clear()
        ms.load_new_mesh(str(tmp_path / "in" / place))
        multires.denoise(ms, strength=2)
        report = multires.low_pass(ms, unit="wavelength percent", cutoff=10, pyramid=multires.Pyramid(scheme="Roy"))
        last = multires.denoise(ms)
        ms.save_current_mesh(str(tmp_path / f"wanted{place[-4:]}"))
        np.testing.assert_array_equal(vertices(tmp_path / "out" / place), vertices(tmp_path / f"wanted{place[-4:]}"))
        row = table[pathlib.Path(place).name]
        assert row["status"] == "ok" and int(row["vertices"]) == ms.current_mesh().vertex_number()
        assert float(row["low_pass.rms_displacement"]) == report.rms_displacement > 0
        assert json.loads(row["low_pass.gains"]) == report.gains.tolist()
        assert float(row["denoise_2.noise"]) == last.noise
    assert table["broken.ply"]["status"] == table["missing.ply"]["status"] == "failed"
    log = (tmp_path / "out/errors.log").read_text().splitlines()
    assert len(log) == 2 and log[0].startswith(str(tmp_path / "in/broken.ply: ")) and "No such file" in log[1]
    assert not leftovers(tmp_path / "out")


def test_a_script_does_what_it_does_in_pymeshlab(multires, meshes, run, tmp_path):
    """One with a filter of ours, which has a report, and one of MeshLab's."""
    script = tmp_path / "script.mlx"
    ours = (ROOT / "examples/denoise-and-enhance.mlx").read_text()
    theirs = '<filter name="Invert Faces Orientation"><Param type="RichBool" name="forceFlip" value="true"/></filter>'
    script.write_text(ours.replace("</FilterScript>", theirs + "</FilterScript>"))
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(meshes / "terrain.ply"))
    ms.load_filter_script(str(script))
    ms.apply_filter_script()
    ms.save_current_mesh(str(tmp_path / "wanted.ply"))
    (record,) = run(script, meshes / "terrain.ply", "-o", tmp_path / "out")
    assert record["status"] == "ok", record
    assert (tmp_path / "out/terrain.ply").read_bytes() == (tmp_path / "wanted.ply").read_bytes()
    assert record["values"]["denoise.noise"] > 0 and record["values"]["enhance.rms_displacement"] > 0


def test_custom_attributes_and_tables_alone(meshes, run, tmp_path):
    words = ("details_by_scale", meshes / "terrain.ply", "-o", tmp_path / "out")
    run(*words, "--attribute", "scale_1", "--attribute", "scale_2")
    head = (tmp_path / "out/terrain.ply").read_bytes()[:900]
    assert b"scale_1" in head and b"scale_2" in head and b"scale_3" not in head
    run(*words[:-1], tmp_path / "reports", "--no-meshes", "--table", tmp_path / "reports/all.parquet")
    import pyarrow.parquet

    table = pyarrow.parquet.read_table(tmp_path / "reports/all.parquet").to_pydict()
    assert table["status"] == ["ok"] and isinstance(table["details_by_scale.wavelengths"][0], list), table.keys()
    assert not list((tmp_path / "reports").rglob("*.ply"))


def test_a_run_that_was_killed_is_resumed_and_leaves_no_half_file(command, sphere, tmp_path):
    inputs, out = several(tmp_path / "in", sphere, 5), tmp_path / "out"
    words = ("low_pass", inputs, "-o", out, "-j", "1")
    first = command(*words)
    soon(lambda: list(out.glob("m*.ply")))
    first.kill()
    first.communicate()
    time.sleep(0.5)  # its child ends with the mesh it has
    written = {path: path.stat().st_mtime_ns for path in out.glob("m*.ply")}
    assert 1 <= len(written) < 5
    noted = len((out / "journal.jsonl").read_text().splitlines())
    with (out / "journal.jsonl").open("a") as journal:
        journal.write('{"torn')
    again = command(*words, "--resume")
    _, said = again.communicate(timeout=60)
    assert again.returncode == 0 and f"{5 - noted} of {5 - noted}" in said, said
    results = {path.read_bytes() for path in out.glob("m*.ply")}
    assert len(list(out.glob("m*.ply"))) == 5 and len(results) == 1 and not leftovers(out)
    assert sum(path.stat().st_mtime_ns == before for path, before in written.items()) >= noted
    assert [row["status"] for row in rows(out / "reports.csv")] == ["ok"] * 5
    os.utime(inputs / "m3.ply")  # as if it had changed
    (out / "m1.ply").unlink()
    _, said = (third := command(*words, "--resume")).communicate(timeout=60)
    assert third.returncode == 0 and "2 of 2" in said


@pytest.mark.parametrize("retries", [0, 1])
def test_a_process_that_dies_costs_its_mesh_alone(run, sphere, tmp_path, retries):
    inputs = several(tmp_path / "in", sphere, 8)  # enough to be at work when it is killed
    before = set(children())

    def kill_one():
        (process,) = soon(lambda: set(children()) - before)
        time.sleep(0.5)  # it loads pymeshlab or works on the mesh
        os.kill(process, signal.SIGKILL)

    killer = threading.Thread(target=kill_one)
    killer.start()
    records = run("low_pass", inputs, "-o", tmp_path / "out", "-j", "1", "--retries", retries)
    killer.join()
    failed = [record["error"] for record in records if record["status"] != "ok"]
    assert failed == [] if retries else len(failed) == 1 and "signal 9" in failed[0]
    assert len(list((tmp_path / "out").glob("*.ply"))) == 7 + retries and not leftovers(tmp_path / "out")


def test_time_and_memory_are_limited(run, meshes, sphere, tmp_path):
    (record,) = run("low_pass", sphere, "-o", tmp_path / "out", "--timeout", "0.05")
    assert record["error"] == "took longer than 0.05 s"
    ms = pymeshlab.MeshSet(verbose=False)
    ms.create_sphere(subdiv=7)  # 160,000 vertices
    ms.save_current_mesh(str(tmp_path / "large.ply"))
    small = meshes / "disk.ply"
    records = run("build_pyramid", small, tmp_path / "large.ply", "-o", tmp_path / "out", "--memory", "0.15")
    assert [record["status"] for record in records] == ["ok", "failed"]
    assert "memory" in records[1]["error"].lower()


def test_meshes_wait_until_there_is_room_for_them(multires):
    from pymeshlab_multires.batch.memory import FIRST_RATE, PROCESS, Room

    size = 10 << 20
    room = Room(2 * PROCESS + int(1.5 * FIRST_RATE * size))
    assert room.estimate("a.ply", size) == PROCESS + FIRST_RATE * size
    entered = []

    def enter(name, first, last):
        with room.take(name, size):
            entered.append(name)
            first.set()
            last.wait(10)

    events = [threading.Event() for _ in range(4)]
    threads = [threading.Thread(target=enter, args=(n, *e)) for n, e in (("a.ply", events[:2]), ("b.ply", events[2:]))]
    threads[0].start()
    events[0].wait(10)
    threads[1].start()
    assert not events[2].wait(0.2) and entered == ["a.ply"]
    room.learn("c.ply", size, size * 20)  # the kind takes less than was thought: asked again when something changes
    events[1].set()
    assert events[2].wait(10)
    events[3].set()
    for thread in threads:
        thread.join()
    assert room.estimate("a.PLY", size) == PROCESS + 20 * size


def test_dask_gives_the_work_of_a_dead_worker_to_another(multires, sphere, tmp_path):
    import distributed
    from pymeshlab_multires.batch import arguments
    from pymeshlab_multires.batch import run as runner

    inputs, out = several(tmp_path / "in", sphere, 4), tmp_path / "out"
    (tmp_path / "in/broken.ply").write_text("no mesh")
    (tmp_path / "dask").mkdir()
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                                  local_directory=str(tmp_path / "dask"),
                                  env={"PYTHONPATH": str(pathlib.Path(multires.__file__).parents[1])}) as cluster:  # fmt: skip
        asked = arguments.batch(["low_pass", str(inputs), "-o", str(out), "--scheduler", cluster.scheduler_address, "-q"])
        victim = cluster.workers[0].process.pid

        def kill():
            soon(lambda: list(out.glob("m*.ply")))
            os.kill(victim, signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        records = runner.run(asked)
        killer.join()
    assert [pathlib.Path(r["input"]).name for r in records if r["status"] != "ok"] == ["broken.ply"]
    assert len(list(out.glob("m*.ply"))) == 4 and len({path.read_bytes() for path in out.glob("m*.ply")}) == 1
    assert not leftovers(out)


@pytest.mark.parametrize(
    "words, said",
    [
        (("denoise",), "no input"),
        (("denosie", "MESH"), "denosie is neither a filter nor a script, did you mean denoise?"),
        (("denoise", "strenth=1", "MESH"), "denoise has no parameter strenth, did you mean strength?"),
        (("low_pass", "unit=levels", "MESH"), "low_pass: unit=levels: must be one of wavelength, .* did you mean level?"),
        (("denoise", "strength=much", "MESH"), "denoise: strength=much: could not convert"),
        (("denoise", "presmooth=2", "MESH"), "denoise: presmooth=2: must be 0 to 1"),
        (("move_region", "translation=1,2", "MESH"), "translation=1,2: must be three numbers"),
        (("strength=1", "MESH"), "strength=1 follows no filter"),
        (("missing.mlx", "MESH"), "there is no script missing.mlx"),
        (("denoise", "MESH", "--format", "step"), "pymeshlab does not write .step"),
        (("denoise", "MESH", "--format", "stl", "--attribute", "height"), "only .ply holds custom attributes"),
        (("denoise", "MESH", "--table", "t.xlsx"), "a table is .csv or .parquet"),
        (("denoise", "MESH", "TWIN"), "would both become"),
        (("denoise", "MESH", "-o", "SAME"), "would replace an input"),
        (("denoise", "no/*.ply"), r"there are no meshes in no/\*.ply"),
    ],
)
def test_a_mistake_is_told_before_anything_is_done(multires, meshes, capsys, tmp_path, words, said):
    from pymeshlab_multires.batch import arguments

    (tmp_path / "disk.ply").write_bytes((meshes / "disk.ply").read_bytes())
    (tmp_path / "disk.stl").write_bytes(b"")
    names = {"MESH": str(tmp_path / "disk.ply"), "TWIN": str(tmp_path / "disk.stl"), "SAME": str(tmp_path)}
    output = ["-o", str(tmp_path / "out")] if "-o" not in words else []
    extra = ["--format", "ply"] if "TWIN" in words else []
    with pytest.raises(SystemExit) as ended:
        arguments.batch([*[names.get(word, word) for word in words], *output, *extra])
    assert ended.value.code == 2
    assert re.search(said, capsys.readouterr().err) and not (tmp_path / "out").exists()
