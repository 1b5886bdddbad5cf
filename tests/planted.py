#!/usr/bin/env python3
"""Plants regressions into a copy of the sources, and sees that the guards raise the alarm; and that
they raise none where nothing was planted.

  tests/planted.py           builds in build/planted; takes about 20 minutes on two idle cores

A slowdown of about 5 % in the loop of all rows over lanes must be noticed by tools/instructions and
by definite compare --paired; a rewrite that rounds badly by definite compare --accuracy; twenty
comparisons of a program with itself must stay silent.

Exit code: 0 all is as it must be, 1 something is not, 2 a build fails."""

import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "planted"
SOURCES = WORK / "sources"
BUILD = SOURCES / "build" / "instructions"  # where tools/instructions builds
ENERGY = "Signed<VertexFace>, Quadratic"
FAST = ["--kernels", "collision/vertex_face/signed/quadratic/analytic/f64x8"]
ROWS = [*FAST, "--kernels", "collision/vertex_face/signed/quadratic/gauss_newton/f64"]

# Eighty idle instructions for each pass of eight configurations.
SLOW = ("kernels/run.hpp", "      Output::Write(sums[i], Pass<E, Tile>",
        "      asm volatile(\".rept 80\\n\\tnop\\n\\t.endr\");\n"
        "      Output::Write(sums[i], Pass<E, Tile>")
# |e0 x e1|^2 as a difference: it cancels where the edges are nearly parallel.
INACCURATE = ("kernels/lengths/collision_frame.hpp",
              "const T area2 = Dot(c, c), aa = Dot(e0, e0), bb = Dot(e1, e1);",
              "const T aa = Dot(e0, e0), bb = Dot(e1, e1);\n"
              "  const T area2 = aa * bb - Dot(e0, e1) * Dot(e0, e1);")


def lay_out(plant=None):
    """Makes the copy equal to the working tree, but for what is planted. Files that are equal keep
    their time, so that little is built again."""
    files = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others",
                            "--exclude-standard"], check=True, stdout=subprocess.PIPE)
    for file in files.stdout.decode().split("\0"):
        source, copy = ROOT / file, SOURCES / file
        if not file or not source.is_file():
            continue
        content = source.read_bytes()
        if plant and file == plant[0]:
            text = content.decode()
            if text.count(plant[1]) != 1:
                sys.exit(f"{file}: what is to be changed is not there once:\n{plant[1]}")
            content = text.replace(plant[1], plant[2]).encode()
        if not copy.is_file() or copy.read_bytes() != content:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(content)
            shutil.copymode(source, copy)


def program(name, plant=None):
    """The program, built with what is planted."""
    lay_out(plant)
    for command in (["cmake", "--preset", "portable", "-B", BUILD, f"-DDEFINITE_ENERGIES={ENERGY}"],
                    ["cmake", "--build", BUILD, "--target", "definite"]):
        if subprocess.run(command, cwd=SOURCES, stdout=subprocess.DEVNULL,
                          check=False).returncode != 0:
            sys.exit(2)
    return shutil.copy(BUILD / "definite", WORK / name)


def sweep(definite):
    """Its result on pairs as they come, many of them nearly degenerate."""
    result = WORK / f"{pathlib.Path(definite).name}.json"
    # A promise that is broken exits with 1.
    subprocess.run([definite, "sweep", "--no-timing", "--count", "1e5", *ROWS, "--json", result],
                   check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return result


failures = []


def expect(what, code, *command):
    done = subprocess.run(list(map(str, command)), cwd=SOURCES, check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    good = done.returncode == code
    print(f"{'ok  ' if good else 'FAIL'} {what}", flush=True)
    if not good:
        failures.append(what)
        print(f"exit code {done.returncode}, expected {code}\n{done.stdout}", flush=True)


def main():
    as_is = program("as_is")
    expect("instructions counted", 0, "tools/instructions", "--update")
    counts = {path: path.read_bytes() for path in (SOURCES / "results/baselines").iterdir()}
    expect("counted again, to the instruction", 0, "tools/instructions", "--exactly")

    slow = program("slow", SLOW)  # takes the working tree's counts back
    for path, content in counts.items():
        path.write_bytes(content)
    expect("a slowdown is seen in the instructions", 1, "tools/instructions")
    expect("a slowdown is seen by programs run in turn", 1,
           as_is, "compare", "--paired", as_is, slow, *FAST)

    inaccurate = program("inaccurate", INACCURATE)
    expect("a loss of accuracy is seen", 1,
           as_is, "compare", "--accuracy", sweep(as_is), sweep(inaccurate))
    expect("the same is as accurate", 0,
           as_is, "compare", "--accuracy", sweep(as_is), sweep(as_is))
    for i in range(20):
        expect(f"nothing is slower than itself ({i + 1} of 20)", 0,
               as_is, "compare", "--paired", as_is, as_is, *ROWS)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
