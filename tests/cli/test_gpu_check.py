"""tools/gpu_check from its first word to its last, on the emulated device of tests/cuda_on_cpu: what builds, tests and looks for
faults is replaced by small programs, what runs scenes and beds is scree itself.

SCREE_BUILD_DIR holds the program with the emulated device in both precisions (scree_emulated, scree_single_emulated).
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("SCREE_SOURCE_DIR", Path(__file__).parents[2]))
BUILD = Path(os.environ.get("SCREE_BUILD_DIR", ROOT / "build/release")).resolve()
PROGRAMS = {"scree": BUILD / "scree_emulated", "scree_single": BUILD / "scree_single_emulated"}
pytestmark = pytest.mark.skipif(not all(p.exists() for p in PROGRAMS.values()), reason="there is no program with the emulated device")

TOOLS = {
    "nvcc": "exit 0",
    "nvidia-smi": 'echo "CUDA on the CPU, 1.0, 8.0, 4096 MiB"',
    "cmake": "exit 0",
    "ctest": 'echo "1/1 Test  #7: test_step_on_gpu ... Passed"; echo "100% tests passed, 0 tests failed out of 1"',
    # runs what it was given, behind its own three options
    "compute-sanitizer": '[ "$SCREE_TEST_ARENA" = 0 ] || exit 1; shift 4; "$@" && echo "========= ERROR SUMMARY: 0 errors"',
}
# scenes end early, beds are measured shortly; WRONG: the state of one scene is another on the GPU
SHORT = """#!/usr/bin/env bash
case "$1 $*" in
run*two_spheres*cuda*) [ -z "${WRONG:-}" ] || set -- "$@" --set gravity.2=-3 ;;&
run*) exec "PROGRAM" "$@" --set time.end=1e-4 ;;
bench*) exec "PROGRAM" "$@" --steps 2 --search-every 2 --repetitions 3 ;;
esac
"""


def write_program(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)


class Machine:
    """A folder with tools and a build."""

    def __init__(self, folder):
        self.folder, self.tools = folder / "build", folder / "tools"
        for name, text in TOOLS.items():
            self.replace(name, text)
        self.replace("python3", f'exec "{sys.executable}" "$@"')
        for name, program in PROGRAMS.items():
            write_program(self.folder / name, SHORT.replace("PROGRAM", str(program)))
        for name in ("test_kernels", "test_contact_kernels", "test_step"):
            write_program(self.folder / "tests" / f"{name}_on_gpu", "#!/bin/sh\nexit 0\n")

    def replace(self, tool, text):
        write_program(self.tools / tool, f"#!/usr/bin/env bash\n{text}\n")

    def check(self, particles="30", **variables):
        """Exit code and words of tools/gpu_check."""
        environment = dict(os.environ, PATH=f"{self.tools}:/usr/bin:/bin", OMP_NUM_THREADS="1", GPU_CHECK_FOLDER=str(self.folder),
                           GPU_CHECK_PARTICLES=particles, **variables)
        report = self.folder / "gpu_report.txt"
        report.unlink(missing_ok=True)
        done = subprocess.run([ROOT / "tools/gpu_check"], text=True, capture_output=True, timeout=300, env=environment)
        if report.exists():
            assert report.read_text() == done.stdout
        return done.returncode, done.stdout + done.stderr


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def test_a_sound_machine(machine):
    code, words = machine.check("30 60 100000000 200000000")
    assert code == 0 and words.rstrip().endswith("all is right") and "FAULT" not in words, words
    assert "CUDA on the CPU, 1.0, 8.0" in words and "tests passed" in words
    # the same scenes in both precisions, with states of their own
    double, single = (dict(re.findall(rf"^{name}\.(\w+): ([0-9a-f]+)$", words, re.MULTILINE)) for name in ("scree", "scree_single"))
    assert len(double) == 6 and set(double) == set(single) and not set(double.values()) & set(single.values())
    assert words.count("0 errors") == 12
    # every bed that fits with its table, and why the next one does not
    for precision in ("double", "single"):
        for bed in ("schoenhardt", "sphere"):
            for particles in (30, 60):
                assert re.search(rf"^{bed}, {particles} particles, .* {precision} precision: .* GB/s$", words, re.MULTILINE)
            assert f"{bed}, 100000000 particles, {precision} precision: left out, the GPU has 4.3 GB of free memory" in words
    assert words.count("| gather |") == 8 and "200000000" not in words


def test_without_a_driver(machine):
    machine.replace("nvidia-smi", "echo no devices were found; exit 6")
    code, words = machine.check()
    assert code == 1 and "nvidia-smi finds no GPU" in words and "==" not in words
    (machine.tools / "nvidia-smi").unlink()
    if not shutil.which("nvidia-smi", path="/usr/bin:/bin"):
        code, words = machine.check()
        assert code == 1 and "install the NVIDIA driver" in words


@pytest.mark.parametrize("cmake, said", [('echo "x.cu: error: no such type"; exit 1', "no such type"), ("exit 1", "the build fails")])
def test_a_build_that_fails(machine, cmake, said):
    machine.replace("cmake", cmake)
    code, words = machine.check()
    assert code == 1 and said in words and "the build fails" in words and "tests on the GPU" not in words


def test_tests_that_cannot_be_run(machine):
    machine.replace("ctest", 'echo "1/1 Test  #7: test_step_on_gpu ...***Skipped"; echo "100% tests passed"')
    code, words = machine.check()
    assert code == 1 and "no GPU can be used" in words and "the same bits" not in words


def test_faults_are_gathered(machine):
    machine.replace("ctest", 'echo "1/1 Test  #7: test_step_on_gpu ...***Failed"; echo "what failed"; exit 8')
    machine.replace("compute-sanitizer", '[ $2 = memcheck ] && echo "Invalid __global__ write" && exit 9; echo "0 errors"')
    code, words = machine.check(WRONG="1")
    assert code == 1 and "what failed" in words and "Invalid __global__ write" in words, words
    faults = words.split("== in all\n")[1].splitlines()
    # of the hashes: both precisions; of the sanitizer: four programs under one of its tools
    assert faults[0] == "tests fail on the GPU"
    assert [fault.split(":")[0] for fault in faults[1:3]] == ["scree.two_spheres", "scree_single.two_spheres"]
    assert all("is not that of the CPU" in fault for fault in faults[1:3])
    assert sum(fault.startswith("compute-sanitizer: memcheck") for fault in faults) == 4
    assert faults[-1] == "gpu_check: 7 faults" and len(faults) == 8
    assert "sphere, 30 particles" in words


def test_a_device_that_breaks(machine):
    (machine.tools / "compute-sanitizer").unlink()
    code, words = machine.check(CUDA_ON_CPU_FAULT_AT="20")
    assert code == 1 and "skipped: there is no compute-sanitizer" in words
    assert words.count("the run on the GPU fails") == 2 * 12 and words.count("the bed of 30 particles fails") == 2 * 4
