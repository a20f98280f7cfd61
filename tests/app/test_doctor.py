"""`lightgesture doctor`: its report, and what it says of a machine on which something is broken."""

import json
import os
import subprocess
import sys

import pytest

from lightgesture.doctor import examination as doctor
from lightgesture.doctor import facts as doctor_facts
from lightgesture.doctor.examination import FIRST, SAMPLE_TEXT, Probe, examine, run_probe, why_not_imported
from lightgesture.doctor.facts import needs_of_extras, processor, read_memory
from lightgesture.doctor.probe import ONLY_FIRST, peak_mib
from lightgesture.errors import ExitStatus

FINDINGS = {
    "instructions": [SAMPLE_TEXT],
    "frames_per_second": 91.5,
    "ms_per_frame": {"median": 7.5, "p95": 12.25},
    "peak_mib": 96.5,
    "video": {"FFMPEG": True, "GSTREAMER": False},
    "classifiers": {"cnn": "cnn.npz: is damaged; restore it", "svm": None},
    "nets": "LiteRT",
}


@pytest.fixture
def probe(monkeypatch):
    """Puts an answer in the place of the processes that decode the clip."""

    def answer(findings=None, failure=None, first_s=0.75):
        def run(arguments):
            is_first = ONLY_FIRST in arguments
            return Probe(first_s, {} if is_first else findings or {}, failure)

        monkeypatch.setattr(doctor, "run_probe", run)

    return answer


def test_a_sound_machine(run, probe):
    probe(FINDINGS)
    result = run("doctor")
    assert (result.status, result.err) == (ExitStatus.OK, [])
    text = "\n".join(result.out)
    assert "91.5 frames a second" in text
    assert "FFMPEG yes, GSTREAMER no" in text
    assert "model svm    works" in text
    assert "0.75 s from a fresh process to its first record, 0.75 s when done again" in text
    assert "96.5 MiB" in text
    assert result.out[-1] == "verdict      all that is needed works"


def test_json_is_one_object(run, probe):
    probe(FINDINGS)
    result = run("doctor", "--json")
    (line,) = result.out
    report = json.loads(line)
    assert report["status"] == "ok"
    assert report["findings"] == FINDINGS
    assert report["start_s"] == {"first": 0.75, "again": 0.75}
    assert report["versions"]["numpy"]
    assert report["machine"]["cores"] >= 1
    assert {"name", "installed", "missing"} == report["extras"][0].keys()


def test_nets_without_their_run_time_are_slower_but_not_broken(run, probe):
    probe({**FINDINGS, "nets": "NumPy"})
    result = run("doctor")
    assert result.status == ExitStatus.OK
    assert any("run by NumPy (slower; pip install ai-edge-litert" in line for line in result.out)


@pytest.mark.parametrize(
    ("texts", "told"), [([], "gives nothing"), (["STOP HOVER GO"], "gives STOP HOVER GO")]
)
def test_a_machine_that_reads_the_clip_otherwise_is_broken(run, probe, texts, told):
    probe({**FINDINGS, "instructions": texts})
    result = run("doctor")
    assert result.status == ExitStatus.SOME_FAILED
    assert any(line.startswith("broken") and told in line for line in result.out)
    assert any(line.startswith("remedy") and "do not let this machine command" in line for line in result.out)


def test_the_library_that_is_broken_is_named_with_its_remedy(run, probe, monkeypatch):
    probe(failure="ImportError: libGL.so.1", first_s=None)
    monkeypatch.setattr(doctor, "why_not_imported", {"cv2": "ImportError: libGL.so.1"}.get)
    result = run("doctor")
    assert result.status == ExitStatus.SOME_FAILED
    text = "\n".join(result.out)
    assert "start        fails before the first record" in text
    assert "broken       cv2: ImportError: libGL.so.1" in text
    assert "pip install --force-reinstall opencv-python-headless" in text


def test_a_failure_that_no_library_explains_is_told_itself(probe, monkeypatch):
    probe(failure="no data file")
    monkeypatch.setattr(doctor, "why_not_imported", lambda module: None)
    (problem,) = examine(doctor.run_probe).problems
    assert (problem.what, problem.reason) == ("decoding", "no data file")


def test_why_a_module_cannot_be_imported(tmp_path, monkeypatch):
    (tmp_path / "broken_here.py").write_text("raise ImportError('two\\nlines of it')")
    (tmp_path / "deadly_here.py").write_text("import os, signal; os.kill(os.getpid(), signal.SIGILL)")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert why_not_imported("json") is None
    assert why_not_imported("broken_here") == "lines of it"
    assert "signal 4" in why_not_imported("deadly_here")


@pytest.fixture
def interpreter(tmp_path, monkeypatch):
    """Puts a script in the place of the interpreter."""

    real = sys.executable

    def make(script):
        path = tmp_path / "python"
        path.write_text(f"#!{real}\n{script}")
        path.chmod(0o755)
        monkeypatch.setattr(doctor.sys, "executable", str(path))

    return make


@pytest.mark.skipif(os.name != "posix", reason="needs scripts that run by themselves")
def test_what_becomes_of_a_probe(interpreter):
    first = f"print('\"{FIRST}\"', flush=True)"
    interpreter(f'{first}; print(\'{{"nets": "NumPy"}}\')')
    good = run_probe([])
    assert good.first_s is not None
    assert good.findings == {"nets": "NumPy"}
    interpreter(f"{first}; raise SystemExit('it broke')")
    assert run_probe([]).failure == "it broke"
    interpreter("raise SystemExit('at once')")
    early = run_probe([])
    assert (early.first_s, early.failure) == (None, "at once")
    interpreter(f"{first}; import time; time.sleep(60)")
    assert run_probe([], timeout_s=0.2).failure == "not done after 0.2 s"


def test_the_real_probe_to_its_first_record():
    probe = run_probe([ONLY_FIRST])
    assert probe.failure is None
    assert probe.first_s > 0


def test_the_first_record_loads_nothing_that_it_does_not_need():
    heavy = {"http.client", "matplotlib", "numba", "numpy.random", "scipy", "sklearn", "ssl", "torch"}
    code = (
        "import sys; from lightgesture.doctor import probe; probe.main([probe.ONLY_FIRST]);"
        f"sys.exit(' '.join(sorted({heavy} & set(sys.modules))))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stderr.strip() == ""
    assert json.loads(done.stdout) == FIRST


@pytest.mark.slow
def test_the_real_machine(run):
    result = run("doctor", "--json")
    report = json.loads(result.out[0])
    assert report["findings"]["classifiers"]["svm"] is None
    assert report["findings"]["peak_mib"] > 10
    assert report["findings"]["instructions"] == [SAMPLE_TEXT]
    assert result.status == ExitStatus.OK


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_peak_memory_holds_what_was_held():
    before = peak_mib()
    block = bytearray(os.urandom(1)) * (64 << 20)
    assert peak_mib() >= before + 32
    assert len(block) == 64 << 20


def test_processors_by_name():
    pi = "processor : 0\nCPU part : 0xd08\nprocessor : 1\n\nModel : Raspberry Pi 4 Model B Rev 1.4\n"
    assert processor(pi) == "Raspberry Pi 4 Model B Rev 1.4, Cortex-A72"
    assert processor("CPU part : 0xfff\n") == "Arm part 0xfff"
    assert processor("processor : 0\nmodel : 17\nmodel name : AMD EPYC\n") == "AMD EPYC"
    assert processor("") == doctor_facts.platform.machine()


def test_memory_in_mib():
    assert read_memory("MemTotal: 2048 kB\nHugePages_Total: 3\n") == {"MemTotal": 2}


def test_libraries_of_extras():
    lines = [
        "numpy>=1.26",
        'torch>=2.4; extra == "train"',
        "distributed[diagnostics]>=2024; extra == 'cluster'",
        'lightgesture[dev,train]; extra == "all"',
        'pytest>=8; python_version > "3" and extra == "dev"',
    ]
    assert needs_of_extras(lines) == {"train": ["torch"], "cluster": ["distributed"], "dev": ["pytest"]}
