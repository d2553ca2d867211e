"""Compiling in tests: a tool that is missing fails them."""

import shutil
import subprocess

STRICT = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off")


def require(*tools):
    """Fail where a tool is missing; .ci/tools installs them."""
    missing = [tool for tool in tools if shutil.which(tool) is None]
    assert not missing, f"install {', '.join(missing)}: bash .ci/tools"


def ran(folder, compiler, *flags, files, wrapper=()):
    """What a program says, once it is compiled from files of a folder without a warning and has ended with 0."""
    require(compiler, *wrapper[:1])
    subprocess.run([compiler, *STRICT, *flags, "-o", "program", *files, "-lm"], cwd=folder, check=True)
    done = subprocess.run([*wrapper, "./program"], cwd=folder, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def object_of(folder, compiler, *flags, file):
    """Compile a file by itself without a warning."""
    require(compiler)
    subprocess.run([compiler, *STRICT, *flags, "-c", file, "-o", "object.o"], cwd=folder, check=True)
