"""definite verify, from outside: python3 verify_test.py DEFINITE BROKEN_DEFINITE [unittest's]

BROKEN_DEFINITE is the same program with a filter that is not PSD.
"""

import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import jsonschema

PROGRAM, BROKEN_PROGRAM = sys.argv[1:3]
ROOT = pathlib.Path(__file__).resolve().parent.parent
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "results/schema.json").read_text()))
ENERGIES = ["collision/vertex_face/signed/quadratic", "strand/bend/quadratic"]
FEW = [word for energy in ENERGIES for word in ("--kernels", energy + "/*")]
TIMEOUT = 300  # seconds; a sanitizer may be slow


def run(*words, program=PROGRAM):
    return subprocess.run([program, *words], capture_output=True, text=True, timeout=TIMEOUT,
                          check=False)


def verify(*words):
    """The JSON of a run that ends well."""
    done = run("verify", "--json", "-", *words)
    if done.returncode != 0:
        raise AssertionError(f"exit {done.returncode}: {done.stderr}")
    result = json.loads(done.stdout)
    VALIDATOR.validate(result)
    return result


def long_lines(text):
    return [line for line in text.splitlines() if len(line) > 100]


class Verify(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.file = pathlib.Path(cls.folder.name) / "result.json"
        cls.done = run("verify", "--count", "20", *FEW, "--json", cls.file)
        cls.result = json.loads(cls.file.read_text())

    def test_it_ends_well_and_its_result_validates(self):
        self.assertEqual((self.done.returncode, self.done.stderr), (0, ""))
        VALIDATOR.validate(self.result)
        self.assertIs(self.result["partial"], False)
        self.assertEqual(self.result["rows"], [])
        found = self.result["verification"]
        self.assertEqual(found["count"], 20)
        self.assertEqual([energy["energy"] for energy in found["energies"]], ENERGIES)
        # Of each distribution that draws pairs; there are some of simplices alone.
        pairs = [d for d in found["distributions"] if not d.startswith(("near_", "inverted"))]
        self.assertEqual({energy["drawn"] for energy in found["energies"]}, {20 * len(pairs)})
        self.assertTrue(all(check["passes"] for check in found["checks"]))

    def test_every_row_asked_for_is_verified(self):
        for energy in self.result["verification"]["energies"]:
            listed = run("list", "--kernels", energy["energy"] + "/*").stdout.split()
            self.assertEqual(energy["rows"], listed)
        for check in ("rows_accurate", "rows_psd"):
            self.assertEqual([c["energy"] for c in self.result["verification"]["checks"]
                              if c["check"] == check and c["configurations"] > 0], ENERGIES)

    def test_every_energy_and_row_passes(self):
        result = verify("--count", "8")["verification"]
        rows = [row for energy in result["energies"] for row in energy["rows"]]
        self.assertEqual(rows, run("list").stdout.split())
        energies = [energy["energy"] for energy in result["energies"]]
        for name in ("value", "gradient", "hessian", "rows_accurate", "rows_psd"):
            self.assertEqual([c["energy"] for c in result["checks"] if c["check"] == name
                              and c["configurations"] > 0], energies)

    def test_the_table_has_a_line_for_each_check_and_energy_within_100_columns(self):
        self.assertEqual(long_lines(self.done.stdout), [])
        parts = self.done.stdout.split("check  ")[1:]
        self.assertEqual(len(parts), len(ENERGIES))
        for part, energy in zip(parts, ENERGIES):
            for check in self.result["verification"]["checks"]:
                if check["energy"] == energy:
                    worst = check["worst"]
                    where = f".* {worst['distribution']} {worst['index']}" if worst else " +-"
                    self.assertRegex(part, rf"(?m)^{check['check']} +{check['configurations']}{where}")
        self.assertIn("all pass", self.done.stdout.splitlines()[-1])

    def test_results_do_not_depend_on_the_number_of_threads(self):
        found = [verify("--count", "20", "--threads", threads, *FEW)["verification"]
                 for threads in ("1", "2", "7")]
        self.assertEqual(found[1:], found[:1] * 2)

    def test_one_configuration_can_be_asked_for(self):
        found = verify(*FEW, "--distribution", "paper", "--index", "7")["verification"]
        self.assertEqual((found["first"], found["count"], found["distributions"]),
                         (7, 1, ["paper"]))
        self.assertEqual({c["worst"]["index"] for c in found["checks"] if c["worst"]}, {7})

    def test_a_failure_exits_1_with_a_line_that_replays_it(self):
        done = run("verify", "--count", "20", program=BROKEN_PROGRAM)
        self.assertEqual(done.returncode, 1)
        self.assertIn("FAILS", done.stdout)
        self.assertIn(ENERGIES[0] + "/analytic/f64: rows_psd fails", done.stderr)
        commands = re.findall(r"^  definite (verify .*)$", done.stderr, re.MULTILINE)
        self.assertNotEqual(commands, [])
        for command in commands:
            again = run(*command.replace("'", "").split(), program=BROKEN_PROGRAM)
            self.assertEqual(again.returncode, 1)

    def test_bad_input_is_named(self):
        for words, named in ((["--count", "0"], "--count '0'"), (["--index", "x"], "--index 'x'"),
                             (["--kernels", "no/such"], "--kernels 'no/such'"),
                             (["--distribution", "papre"], "--distribution 'papre'"),
                             (["--quick", "--count", "5"], "--quick"),
                             (["--errata", "--count", "5"], "--errata"),
                             (["--markdown", "x.md"], "--errata"), (["extra"], "'extra'"),
                             (["--index", "1", "--quick"], "--quick"),
                             (["--threads", "0"], "--threads '0'"), (["--json", ""], "--json")):
            with self.subTest(words=words):
                done = run("verify", *words)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(named, done.stderr)
                self.assertEqual(done.stdout, "")

    def test_help_has_the_checks_and_examples_within_100_columns(self):
        done = run("verify", "--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for word in ("Examples:", "inertia", "default: 1000"):
            self.assertIn(word, done.stdout)
        self.assertEqual(long_lines(done.stdout), [])

    def test_interrupted_on_a_terminal_it_saves_what_is_complete(self):
        file = pathlib.Path(self.folder.name) / "partial.json"
        master, terminal = pty.openpty()
        with subprocess.Popen([PROGRAM, "verify", "--count", "1e7", *FEW, "--json", file],
                              stdout=subprocess.PIPE, stderr=terminal) as process:
            shown = ""
            while "verify" not in shown:
                shown += os.read(master, 65536).decode()
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=TIMEOUT)
        self.assertEqual(process.returncode, 130)
        result = json.loads(file.read_text())
        VALIDATOR.validate(result)
        self.assertIs(result["partial"], True)


class Errata(unittest.TestCase):
    def test_the_page_is_what_is_measured(self):
        page = (ROOT / "docs/errata.md").read_text()
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "errata.md"
            done = run("verify", "--errata", "--markdown", file)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual(file.read_text(), page)
        self.assertEqual(done.stdout, page)
        self.assertEqual(long_lines(page), [])
        for equation in ("Eq. 25", "Eq. 31", "Eq. 32", "Eq. 35", "g_l after Eq. 10"):
            self.assertIn(f"## {equation}\n", page)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
