"""Sets up the peers and has them measured: `python3 run.py FIXTURES WORK OUT [options]`.

Makes a virtual environment in WORK with what `requirements.txt` pins, compiles the C++ peers, and
starts `measure.py` in the environment, and, given files of `--leading-modes` and `--clusters`, their
peers by `large.py`. What cannot be had here is named with the reason in
OUT/notes.txt. Needs Python 3.11 or later and, for its C++ part and JiTCODE, a C++ compiler.
"""

import argparse
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import large

HERE = Path(__file__).resolve().parent
CPP_OPTIONS = ["-std=c++17", "-O3", "-march=native", "-DNDEBUG"]
# Where apt-get is, Boost's headers are unpacked from this package without being installed.
BOOST_PACKAGE = "libboost1.74-dev"


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("fixtures", type=Path, help="folder of the networks, as text")
    arguments.add_argument("work", type=Path, help="folder for what is installed and compiled")
    arguments.add_argument("out", type=Path, help="folder for peers.csv and notes.txt")
    arguments.add_argument("--core", default="0", help="the processor core that all run on")
    arguments.add_argument("--seconds", default="0.3", help="least time of a measurement")
    arguments.add_argument("--repeats", default="5", help="measurements, of which the best counts")
    arguments.add_argument("--only", default="", help="only peers whose file names hold such a text, a,b")
    arguments.add_argument("--longest", default="30", help="seconds allowed on a large network")
    arguments.add_argument("--no-simulation", action="store_true", help="only large networks")
    arguments.add_argument("--leading-modes", nargs="*", type=Path, default=[], help="networks")
    arguments.add_argument("--clusters", nargs="*", type=Path, default=[], help="rows of modes")
    options = arguments.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    notes = []
    python = environment(options.work / "venv", notes)
    if options.leading_modes:
        large.leading_modes(options.leading_modes, python, options, notes)
    if options.clusters:
        large.clusters(options.clusters, python, options, notes)
    peers = []
    if not options.no_simulation:
        peers = compile_all(options.work, notes)
        reason = "no peer has been written for it" if shutil.which("julia") else "there is no julia here"
        notes.append(f"DifferentialEquations.jl is not measured: {reason}")
    with open(options.out / "notes.txt", "a", encoding="utf-8") as file:
        file.writelines(f"{note}\n" for note in notes)
    for note in notes:
        progress(note)
    if options.no_simulation:
        sys.exit(0)
    command = [python, HERE / "measure.py", options.fixtures, options.work, options.out, *peers]
    command += ["--core", options.core, "--seconds", options.seconds]
    command += ["--repeats", options.repeats, "--only", options.only]
    no_caches = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"}
    sys.exit(subprocess.run(command, check=False, env=no_caches).returncode)


def environment(folder, notes):
    """The Python of an environment that holds what can be installed of `requirements.txt`."""
    python = folder / "bin" / "python"
    if not python.exists():
        progress(f"making {folder}")
        venv.create(folder, with_pip=True, clear=True)
    lines = (HERE / "requirements.txt").read_text(encoding="ascii").splitlines()
    requirements = [line for line in lines if line and not line.startswith("#")]
    install = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    if attempt([*install, *requirements]) is not None:
        # One at a time, so that what cannot be installed keeps out nothing else.
        for requirement in requirements:
            progress(f"installing {requirement}")
            if (reason := attempt([*install, requirement])) is not None:
                notes.append(f"{requirement} could not be installed: {reason}")
    return python


def compile_all(work, notes):
    """The programs of the C++ peers that compile here."""
    compiler = next(filter(shutil.which, [os.environ.get("CXX", "c++"), "g++", "clang++"]), None)
    if compiler is None:
        notes.append("the C++ peers and JiTCODE are not measured: there is no C++ compiler here")
        return []
    programs = []
    for source, options in [("cpp_rk4", []), ("odeint_rk4", boost(compiler, work, notes))]:
        if options is None:
            continue
        progress(f"compiling {source}")
        program = (work / source).resolve()
        named = f'-DCOMPILER="{compiler_name(compiler)}"'
        code = [HERE / f"{source}.cpp", "-o", program]
        reason = attempt([compiler, *CPP_OPTIONS, *options, named, *code])
        if reason is None:
            programs.append(program)
        else:
            notes.append(f"{source}.cpp is not measured, as it could not be compiled: {reason}")
    return programs


def compiler_name(compiler):
    output = subprocess.run(
        [compiler, "-dumpfullversion", "-dumpversion"], capture_output=True, text=True, check=True
    )
    return f"{Path(compiler).name} {output.stdout.split()[0]}"


def boost(compiler, work, notes):
    """The compiler's options with which Boost.Odeint is found; None where it cannot be had."""
    probe = [
        compiler,
        "-x",
        "c++",
        "-fsyntax-only",
        "-include",
        "boost/numeric/odeint.hpp",
        os.devnull,
    ]
    unpacked = work / "boost"
    own = ["-isystem", unpacked / "usr" / "include"]
    if attempt(probe) is None:
        return []
    if not unpacked.exists():
        progress(f"unpacking {BOOST_PACKAGE}")
        reason = attempt(["apt-get", "download", BOOST_PACKAGE], cwd=work)
        packages = sorted(work.glob(f"{BOOST_PACKAGE}_*.deb"))
        if reason is None and packages:
            reason = attempt(["dpkg-deb", "-x", packages[-1], unpacked])
        if reason is not None:
            notes.append(f"Boost.Odeint is not measured: no Boost here, and {reason}")
            return None
    return own


def attempt(command, **options):
    """None when a command succeeds, otherwise the last line of what it says."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    except OSError as error:
        return str(error)
    if done.returncode == 0:
        return None
    said = done.stderr.strip() or done.stdout.strip() or f"exit status {done.returncode}"
    return said.splitlines()[-1]


def progress(text):
    print(f"peers: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
