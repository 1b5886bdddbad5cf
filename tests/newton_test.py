"""definite newton, from outside."""

import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEFINITE = sys.argv[1]
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "results/schema.json").read_text()))
FILTERS = ("none", "gauss_newton", "analytic", "numeric_frame", "numeric", "nearest", "absolute",
           "stomakhin")

TETRAHEDRON = """v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
"""


def run(*words):
    return subprocess.run([DEFINITE, *words], capture_output=True, text=True, check=False,
                          timeout=300)


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in ("timing", "ns")}
    if isinstance(value, list):
        return [without_times(v) for v in value if not (isinstance(v, dict) and
                                                        v.get("measure") == "time")]
    return value


class Newton(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def newton(self, *words):
        path = self.folder / "newton.json"
        done = run("newton", "--json", str(path), *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(path.read_text())
        VALIDATOR.validate(result)
        self.assertLessEqual(max(map(len, done.stdout.splitlines()), default=0), 100)
        return result["newton"], done.stdout

    def test_a_quick_run_solves_every_problem_of_its_energy(self):
        begin = time.monotonic()
        result, text = self.newton("--quick")
        self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual(len(result["problems"]), 13)
        for problem in result["problems"]:
            self.assertIn(problem["name"], text)
            self.assertEqual([r["filter"] for r in problem["runs"]],
                             [f for f in FILTERS if f != "gauss_newton"])
            values = set()
            for one in problem["runs"]:
                self.assertEqual(len(one["history"]), one["iterations"])
                self.assertEqual(len(one["reached"]), 2)
                if one["filter"] != "none":
                    self.assertEqual(one["outcome"], "converged", (problem["name"], one["filter"]))
                    self.assertLessEqual(one["gradient"], 1e-8)
                    self.assertEqual(one["reached"][1]["iterations"], one["iterations"])
                    values.add(round(one["value"], 6))
            self.assertEqual(len(values), 1, problem["name"])
        self.assertEqual([(p["tolerance"], p["measure"]) for p in result["profiles"]],
                         [(1e-4, "iterations"), (1e-4, "time"), (1e-8, "iterations"),
                          (1e-8, "time")])
        for profile in result["profiles"]:
            self.assertEqual(profile["taus"], [1, 1.5, 2, 5])
            for line in profile["filters"]:
                self.assertEqual(line["shares"], sorted(line["shares"]))
            self.assertGreaterEqual(sum(l["shares"][0] for l in profile["filters"]), 1)

    def test_only_times_differ_between_runs(self):
        words = ("disk_ball", "bar_*", "--quick", "--energy", "arap", "stable_neo_hookean",
                 "--filter", "analytic", "numeric", "none")
        one, two = (self.newton(*words)[0] for _ in range(2))
        self.assertEqual(without_times(one), without_times(two))
        self.assertEqual(len(one["problems"]), 2 * 7)
        other = self.newton(*words, "--seed", "43")[0]
        self.assertNotEqual(without_times(one), without_times(other))

    def test_a_filter_that_does_not_converge_is_explained(self):
        result, text = self.newton("bar_bend_abrupt", "--quick", "--energy", "arap")
        outcomes = {r["filter"]: r["outcome"] for r in result["problems"][0]["runs"]}
        self.assertEqual(outcomes["none"], "not_descending")
        self.assertRegex(text, r"none after \d+ iterations: the energy does not fall along the step")
        result, text = self.newton("disk_cone", "--quick", "--max-iterations", "2", "--filter",
                                   "analytic")
        self.assertEqual(result["problems"][0]["runs"][0]["outcome"], "iteration_limit")
        self.assertEqual(result["problems"][0]["runs"][0]["reached"][0]["iterations"], None)
        self.assertIn("analytic after 2 iterations: not converged", text)

    def test_tolerances_and_solvers_are_as_asked(self):
        loose = self.newton("bar_bend", "--quick", "--filter", "analytic", "--tolerance", "1e-2")[0]
        self.assertEqual(loose["tolerances"], [1e-2])
        both = self.newton("bar_bend", "--quick", "--filter", "analytic", "--tolerance", "1e-6",
                           "1e-2", "--solver", "cg")[0]
        self.assertEqual(both["tolerances"], [1e-2, 1e-6])
        self.assertEqual(both["solver"], "conjugate_gradients")
        self.assertGreater(both["problems"][0]["runs"][0]["solver_iterations"], 0)
        self.assertLess(loose["problems"][0]["runs"][0]["iterations"],
                        both["problems"][0]["runs"][0]["iterations"])

    def test_a_surface_of_the_user_is_cut_and_laid_out(self):
        path = self.folder / "closed.obj"
        path.write_text(TETRAHEDRON)
        result = self.newton("--obj", str(path), "--energy", "arap", "--filter", "analytic")[0]
        problem = result["problems"][0]
        self.assertEqual(problem["elements"], 4)
        self.assertGreater(problem["vertices"], 4)
        self.assertEqual(problem["runs"][0]["outcome"], "converged")
        self.assertLess(problem["runs"][0]["value"], 1e-12)  # a tetrahedron unfolds

    def test_an_interrupt_keeps_complete_problems(self):
        path = self.folder / "partial.json"
        words = ("newton", "--tolerance", "1e-12", "--json", str(path))
        with subprocess.Popen([DEFINITE, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as child:
            time.sleep(1.5)
            child.send_signal(signal.SIGINT)
            error = child.communicate(timeout=60)[1]
        self.assertEqual(child.returncode, 130)
        self.assertIn("interrupted", error)
        result = json.loads(path.read_text())
        VALIDATOR.validate(result)
        self.assertTrue(result["partial"])
        self.assertLess(len(result["newton"]["problems"]), result["newton"]["all_problems"])

    def test_bad_input_is_explained(self):
        bad = self.folder / "bad.obj"
        bad.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n")
        for words, message in (
                (("disk",), "PROBLEM 'disk': expected all or one of"),
                (("--energy", "arab"), "--energy 'arab': expected one of arap, corotational"),
                (("--energy", "mips", "--", "bar_bend"), "PROBLEM 'bar_bend': expected an energy"),
                (("block_scrambled",), "PROBLEM 'block_scrambled': expected an energy"),
                (("--filter", "analytical"), "--filter 'analytical': expected one of"),
                (("--tolerance", "0"), "--tolerance '0': expected a number between 0 and 1"),
                (("--tolerance", "1e-4x"), "--tolerance '1e-4x': expected a number"),
                (("--tolerance", "1e-2", "1e-4", "1e-6"), "--tolerance: expected at most 2"),
                (("--max-iterations", "0"), "--max-iterations '0': expected at least 1"),
                (("--solver", "lu"), "--solver 'lu': expected ldlt or cg"),
                (("--obj", str(bad)), "line 4: '7': expected a vertex from 1 to 3"),
                (("--obj", "none.obj"), "--obj 'none.obj': cannot read it"),
                (("disk_cone", "--obj", str(bad)), "--obj")):
            done = run("newton", *words)
            self.assertEqual(done.returncode, 2, (words, done.stdout))
            self.assertIn(message, done.stderr)

    def test_the_problems_are_listed(self):
        text = run("newton", "--list").stdout
        for name in ("disk_ball", "bar_twist", "block_scrambled", "bar_swing"):
            self.assertIn(name, text)
        self.assertLessEqual(max(map(len, text.splitlines())), 100)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
