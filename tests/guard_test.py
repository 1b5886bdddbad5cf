"""What guards against regressions, from outside: python3 guard_test.py DEFINITE [unittest's]

Shards, merge and resume; compare, export and doctor.
"""

import copy
import itertools
import json
import os
import pathlib
import random
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

import jsonschema

PROGRAM = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parent.parent
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "results/schema.json").read_text()))
TIMEOUT = 120
COMPARE_PY = pathlib.Path("/usr/share/benchmark/compare.py")  # where Debian has it
MICRO = pathlib.Path(PROGRAM).parent / "benchmarks/kernels_benchmark"
ENERGY = "collision/vertex_face/signed/quadratic"
# Two energies, and rows that break rank: an indefinite one, one that is looked at in samples only.
ROWS = [word for name in (f"{ENERGY}/none/f64", f"{ENERGY}/analytic/f64x8", f"{ENERGY}/numeric/f64",
                          "collision/vertex_face/unsigned/quadratic/analytic/f64")
        for word in ("--kernels", name)]
PLAN = ["--count", "3001", "--seed", "5", "--distribution", "normal", *ROWS]


def run(*words, environment=None, timeout=TIMEOUT):
    return subprocess.run([PROGRAM, *map(str, words)], check=False, text=True, timeout=timeout,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          env={**os.environ, **(environment or {})})


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def ok(self, *words, **options):
        done = run(*words, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def fails(self, *words, code=2, says=()):
        done = run(*words)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, done.stderr)
        return done

    def write(self, name, result):
        path = self.folder / name
        path.write_text(json.dumps(result))
        return path


class Shards(InFolder):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.kept.cleanup)
        cls.single = pathlib.Path(cls.kept.name) / "single.json"
        done = run("sweep", *PLAN, "--no-timing", "--json", cls.single)
        assert done.returncode == 0, done.stderr
        cls.canonical = cls.merged([cls.single], "canonical.json").read_bytes()

    @classmethod
    def merged(cls, parts, name):
        path = pathlib.Path(cls.kept.name) / name
        done = run("merge", *parts, "--json", path)
        assert done.returncode == 0, done.stderr
        return path

    def shards(self, count, *words):
        paths = []
        for i in range(1, count + 1):
            paths.append(self.folder / f"{i}-of-{count}.json")
            self.ok("sweep", *PLAN, "--no-timing", "--threads", i % 3 + 1, "--shard",
                    f"{i}/{count}",
                    "--json", paths[-1], *words)
        return paths

    def test_the_canonical_form_fits_the_schema_and_is_its_own(self):
        result = json.loads(self.canonical)
        VALIDATOR.validate(result)
        self.assertFalse(result["partial"])
        for key in ("command", "machine"):
            self.assertNotIn(key, result)
        again = self.merged([self.merged([self.single], "one.json")], "two.json")
        self.assertEqual(again.read_bytes(), self.canonical)

    def test_it_has_the_single_run_s_statistics(self):
        single, whole = json.loads(self.single.read_text()), json.loads(self.canonical)
        VALIDATOR.validate(single)
        for a, b in zip(single["rows"], whole["rows"], strict=True):
            for key in ("kernel", "count", "active", "verdicts", "checksum", "broken_promises"):
                self.assertEqual(a[key], b[key])
            for name, figure in a["accuracy"].items():
                if isinstance(figure, dict):
                    figure["max"]["exact"] = None
                self.assertEqual(figure, b["accuracy"][name])

    def test_any_number_of_shards_in_any_order_gives_the_same_bytes(self):
        for count in (1, 3, 7):
            parts = self.shards(count)
            random.Random(count).shuffle(parts)
            parts.append(parts[0])  # once more
            self.assertEqual(self.merged(parts, "sum.json").read_bytes(), self.canonical, count)

    def test_mergers_of_mergers_do_too(self):
        a, b, c = self.shards(3)
        ab, bc = self.merged([a, b], "ab.json"), self.merged([c, b], "bc.json")
        self.assertTrue(json.loads(ab.read_text())["partial"])
        for parts in ([ab, c], [c, ab], [a, bc], [ab, a, c], [ab, bc, a], [ab, bc, c, a]):
            self.assertEqual(self.merged(parts, "sum.json").read_bytes(), self.canonical, parts)
        self.fails("merge", ab, bc, says="overlap")

    def test_missing_parts_are_named(self):
        done = self.ok("merge", *self.shards(3)[1:], "--json", self.folder / "sum.json")
        self.assertIn("parts are missing: of 2 energies", done.stderr)

    def test_more_shards_than_blocks_are_some_empty_ones(self):
        parts = []
        for i in range(1, 21):
            parts.append(self.folder / f"{i}.json")
            self.ok("sweep", *PLAN, "--shard", f"{i}/20", "--json", parts[-1])
        self.assertEqual(self.merged(parts, "sum.json").read_bytes(), self.canonical)

    def test_the_environment_says_which(self):
        parts = []
        for i in range(3):
            parts.append(self.folder / f"{i}.json")
            self.ok("sweep", *PLAN, "--no-timing", "--shard", "auto", "--json", parts[-1],
                    environment={"GTEST_SHARD_INDEX": str(i), "GTEST_TOTAL_SHARDS": "3"})
        self.assertEqual(self.merged(parts, "sum.json").read_bytes(), self.canonical)

    def test_other_plans_are_refused(self):
        other = self.folder / "other.json"
        for words, says in ((["--seed", "6"], "seed 5 and 6"), (["--count", "3000"], "count"),
                            (["--set", "eps=0.5"], "set"),
                            (["--kernels", f"{ENERGY}/split/f64"], "kernels"),
                            (["--distribution", "paper"], "distribution")):
            plan = PLAN.copy()
            if words[0] in plan and words[0] != "--kernels":
                at = plan.index(words[0])
                del plan[at:at + 2]
            self.ok("sweep", *plan, *words, "--no-timing", "--json", other)
            self.fails("merge", self.single, other, says=["two plans", says])

    def test_other_content_and_other_programs_are_refused(self):
        result = json.loads(self.single.read_text())
        for change, says in (
                (lambda r: r["blocks"][ENERGY][3].__setitem__(1, "0" * 16), "different outputs"),
                (lambda r: r["blocks"][ENERGY].pop(), "its blocks hold"),
                (lambda r: r["blocks"][ENERGY][3].__setitem__(0, 7), "no block begins at 7"),
                (lambda r: r["build"].__setitem__("compiler", "CC 1"), "another program"),
                (lambda r: r.__setitem__("protocol", "0" * 64), "another protocol"),
                (lambda r: r["rows"].pop(), "results/schema.json"),
                (lambda r: r["rows"][1]["accuracy"]["distance"]["histogram"].pop(), "histogram"),
                (lambda r: r["plan"]["kernels"].__setitem__(0, "a/b"), "no such row"),
                (lambda r: r.pop("plan"), "written with its histograms")):
            changed = copy.deepcopy(result)
            change(changed)
            self.fails("merge", self.single, self.write("changed.json", changed),
                       says=["changed.json" if "outputs" not in says else "merge", says])
        (self.folder / "no.json").write_text("{")
        self.fails("merge", self.folder / "no.json", says="schema definite/1")
        self.fails("merge", self.folder / "none.json", says="cannot read")

    def test_bad_words_are_refused(self):
        self.fails("sweep", *PLAN, "--shard", "8/7", says=["--shard '8/7'", "2/7"])
        self.fails("sweep", *PLAN, "--resume", says="--json FILE")
        self.fails("sweep", *PLAN, "--no-checks", "--no-timing", says="excludes")


class Resume(InFolder):
    # Two energies; the file is written when the first is done.
    WORDS = ["--count", "30000", "--no-timing", "--threads", "2",
             "--kernels", f"{ENERGY}/analytic/*",
             "--kernels", "collision/vertex_face/unsigned/quadratic/analytic/*"]

    def canonical(self, path):
        self.ok("merge", path, "--json", self.folder / "canonical.json")
        return (self.folder / "canonical.json").read_bytes()

    def start(self, path):
        return subprocess.Popen([PROGRAM, "sweep", *self.WORDS, "--resume", "--json", path],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def test_a_killed_run_goes_on_where_it_was(self):
        single, resumed = self.folder / "single.json", self.folder / "resumed.json"
        self.ok("sweep", *self.WORDS, "--json", single)
        process = self.start(resumed)
        deadline = time.monotonic() + TIMEOUT
        while not resumed.exists() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.001)
        process.send_signal(signal.SIGKILL)
        process.wait()
        part = json.loads(resumed.read_text())
        VALIDATOR.validate(part)
        self.assertTrue(part["partial"])
        self.assertGreater(len(part["blocks"][ENERGY]), 0)
        self.ok("sweep", *self.WORDS, "--resume", "--json", resumed)
        self.assertEqual(self.canonical(resumed), self.canonical(single))
        self.ok("sweep", *self.WORDS, "--resume", "--json", resumed)  # nothing is left to check
        self.assertEqual(self.canonical(resumed), self.canonical(single))

    def test_an_interrupted_run_goes_on_too(self):
        resumed = self.folder / "resumed.json"
        process = self.start(resumed)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertIn(process.wait(TIMEOUT), (0, 130))
        self.ok("sweep", *self.WORDS, "--resume", "--json", resumed)
        self.ok("sweep", *self.WORDS, "--json", self.folder / "single.json")
        self.assertEqual(self.canonical(resumed), self.canonical(self.folder / "single.json"))

    def test_another_plan_s_file_is_refused_and_kept(self):
        path = self.folder / "other.json"
        self.ok("sweep", *PLAN, "--no-timing", "--json", path)
        before = path.read_bytes()
        self.fails("sweep", *self.WORDS, "--resume", "--json", path, says=["--resume", "two plans"])
        self.assertEqual(path.read_bytes(), before)


class Compare(InFolder):
    @classmethod
    def setUpClass(cls):
        done = run("sweep", "--count", "8000", "--distribution", "normal", *ROWS, "--threads", "1",
                   "--json", "-")
        assert done.returncode == 0, done.stderr
        cls.result = json.loads(done.stdout)
        VALIDATOR.validate(cls.result)

    def slower(self, factor, where=f"{ENERGY}/analytic/f64x8"):
        result = copy.deepcopy(self.result)
        for row in result["rows"]:
            for timing in row["timing"]:
                # Noise of its own, the same in every run of this test.
                noise = random.Random(row["kernel"])
                by = factor if row["kernel"] == where else 1
                timing["samples"] = [by * ns * noise.uniform(0.995, 1.005)
                                     for ns in timing["samples"]]
        return result

    def test_the_same_is_not_slower(self):
        base, new = self.write("base.json", self.result), self.write("new.json", self.slower(1))
        done = self.ok("compare", base, new)
        self.assertIn("0 slower, 0 faster", done.stdout)
        self.assertEqual([line for line in done.stdout.splitlines() if len(line) > 100], [])

    def test_a_slower_row_is_named_and_exits_1(self):
        base, new = self.write("base.json", self.result), self.write("new.json", self.slower(1.05))
        markdown, out = self.folder / "comment.md", self.folder / "out.json"
        done = self.fails("compare", base, new, "--markdown", markdown, "--json", out, code=1)
        self.assertRegex(done.stdout, rf"SLOWER\n +{ENERGY}/analytic/f64x8, normal, all pairs")
        self.assertTrue(markdown.read_text().startswith("### Slower\n"))
        verdicts = {row["row"]: row["verdict"] for row in json.loads(out.read_text())["rows"]}
        self.assertEqual({row for row, verdict in verdicts.items() if verdict != "same"},
                         {row for row in verdicts if "analytic/f64x8" in row})
        self.ok("compare", base, new, "--threshold", "8")
        self.ok("compare", base, new, "--aa", self.write("aa.json", self.slower(
            1.2, "collision/vertex_face/unsigned/quadratic/analytic/f64")))

    def test_other_machines_builds_and_plans_are_refused_unless_across(self):
        base = self.write("base.json", self.result)
        for place, key, value in (("machine", "cpu", "another"), ("machine", "cores", 99),
                                  ("build", "flags", "-O0"), ("build", "compiler", "CC 1"),
                                  ("plan", "count", 7), ("plan", "distribution", "paper")):
            other = copy.deepcopy(self.result)
            other[place][key] = value
            new = self.write("new.json", other)
            self.fails("compare", base, new, says=["not of the same kind", key, "--across"])
            self.ok("compare", base, new, "--across")
        other = copy.deepcopy(self.result)
        other["schema"] = "definite/2"
        self.fails("compare", base, self.write("new.json", other), says="schema definite/1")

    def test_results_without_times_are_refused(self):
        path = self.folder / "untimed.json"
        self.ok("sweep", *PLAN, "--no-timing", "--json", path)
        self.fails("compare", path, path, says=["untimed.json", "no times"])
        self.fails("compare", ROOT / "results/published/shi-kim-2023.json",
                   ROOT / "results/published/shi-kim-2023.json", says="no times by the round")

    def test_an_accuracy_loss_exits_1(self):
        base = self.write("base.json", self.result)
        self.ok("compare", "--accuracy", base, base)
        other = copy.deepcopy(self.result)
        other["rows"][1]["accuracy"]["conditioned_rounding"]["max"]["value"] = 400.0
        other["rows"][1]["verdicts"]["degraded"] += 2
        markdown = self.folder / "comment.md"
        done = self.fails("compare", "--accuracy", base, self.write("new.json", other),
                          "--markdown", markdown, code=1)
        self.assertIn("WORSE  conditioned_rounding, max: ", done.stdout)
        self.assertIn("WORSE  degraded: 0 -> 2", done.stdout)
        self.assertTrue(markdown.read_text().startswith("### Less accurate\n"))
        self.ok("compare", "--accuracy", self.write("new.json", other), base)

    def test_speed_s_results_compare_too(self):
        path = self.folder / "speed.json"
        self.ok("speed", "--kernels", f"{ENERGY}/none/*", "--ring", "L1", "--threads", "1", "--job",
                "0", "--elements", "0", "--rounds", "5", "--json", path)
        VALIDATOR.validate(json.loads(path.read_text()))
        self.assertIn("0 slower, 0 faster", self.ok("compare", path, path).stdout)

    def test_two_programs_are_run_in_turn(self):
        words = ["--paired", "--rounds", "5", "--count", "4000", "--threshold", "50", "--kernels",
                 f"{ENERGY}/none/f64", "--kernels", f"{ENERGY}/analytic/f64x8"]
        done = self.ok("compare", PROGRAM, PROGRAM, *words)
        self.assertIn("4 rows: 0 slower", done.stdout)
        # A program that says it takes twice the time.
        slow = self.folder / "slow program's"
        slow.write_text(f"#!{sys.executable}\nimport json, subprocess, sys\n"
                        f"r = json.loads(subprocess.run([{PROGRAM!r}, *sys.argv[1:]], check=True, "
                        "stdout=subprocess.PIPE).stdout)\n"
                        "for row in r['rows']:\n  for t in row['timing']:\n"
                        "    t['samples'] = [2 * ns for ns in t['samples']]\n"
                        "print(json.dumps(r))\n")
        slow.chmod(slow.stat().st_mode | stat.S_IXUSR)
        words[2] = "6"
        done = self.fails("compare", PROGRAM, slow, *words, code=1)
        self.assertEqual(done.stdout.count("SLOWER"), 4)
        self.fails("compare", PROGRAM, self.folder / "none", *words, says="this failed")
        self.fails("compare", PROGRAM, "/bin/true", *words, says="wrote no JSON")

    def test_bad_words_are_refused(self):
        base = self.write("base.json", self.result)
        self.fails("compare", base, base, "--threshold", "x", says="--threshold 'x'")
        self.fails("compare", base, says="NEW")
        self.fails("compare", base, base, "--paired", "--accuracy", says="excludes")


class Recipes(InFolder):
    """What users copy."""

    def script(self, path, *words, code=0, **environment):
        done = subprocess.run([ROOT / path, *map(str, words)], check=False, text=True,
                              cwd=self.folder, timeout=TIMEOUT, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE,
                              env={**os.environ, "DEFINITE": os.path.abspath(PROGRAM),
                                   "COUNT": "3001", **environment})
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def assert_whole(self, path):
        self.ok("sweep", *ROWS, "--count", "3001", "--no-timing", "--json",
                self.folder / "single.json")
        self.ok("merge", self.folder / "single.json", "--json", self.folder / "canonical.json")
        self.assertEqual(path.read_bytes(), (self.folder / "canonical.json").read_bytes())

    def test_a_slurm_array(self):
        for i in (1, 2):
            self.script("docs/examples/slurm-array.sh", *ROWS, SLURM_ARRAY_TASK_ID=str(i),
                        SLURM_ARRAY_TASK_MIN="1", SLURM_ARRAY_TASK_COUNT="2")
        self.ok("merge", self.folder / "part-1.json", self.folder / "part-2.json", "--json",
                self.folder / "whole.json")
        self.assert_whole(self.folder / "whole.json")

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_gnu_parallel(self):
        self.script("docs/examples/parallel.sh", *ROWS)
        self.assert_whole(self.folder / "whole.json")

    @unittest.skipUnless(shutil.which("mpirun") and "libmpi" in subprocess.run(
        ["ldd", PROGRAM], check=True, text=True, stdout=subprocess.PIPE).stdout,
        "the program was built without MPI")
    def test_ranks_of_mpirun(self):
        options = "--oversubscribe --allow-run-as-root"
        for ranks in ("2", "4"):
            self.script("docs/examples/mpi.sh", *ROWS, RANKS=ranks, MPI_OPTIONS=options)
            self.assert_whole(self.folder / "whole.json")
            (self.folder / "whole.json").unlink()
        # An error on the first rank ends the others.
        blocked = self.folder / "whole.json"
        blocked.mkdir()
        done = self.script("docs/examples/mpi.sh", *ROWS, code=2, RANKS="2", MPI_OPTIONS=options)
        self.assertIn("--json 'whole.json'", done.stderr)

    @unittest.skipUnless(COMPARE_PY.is_file() and MICRO.is_file(),
                         "Google Benchmark's tools are not installed")
    def test_google_benchmark_s_own_comparison(self):
        for name in ("old", "new"):
            subprocess.run([MICRO, f"--benchmark_filter=^{ENERGY}/(analytic|gauss_newton)/f64$",
                            "--benchmark_min_time=0.01", "--benchmark_repetitions=3",
                            f"--benchmark_out={self.folder / name}.json",
                            "--benchmark_out_format=json"], check=True, timeout=TIMEOUT,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        done = subprocess.run(["/usr/bin/python3", COMPARE_PY, "benchmarks",
                               self.folder / "old.json", self.folder / "new.json"], check=True,
                              text=True, timeout=TIMEOUT, stdout=subprocess.PIPE)
        for filter_name in ("analytic", "gauss_newton"):
            self.assertRegex(done.stdout, rf"{ENERGY}/{filter_name}/f64_pvalue")

    def test_two_builds_held_against_each_other(self):
        program = os.path.abspath(PROGRAM)
        words = ["--kernels", f"{ENERGY}/none/f64", "--count", "4000", "--threshold", "50"]
        self.script("tools/guard", program, program, "out", *words)
        text = (self.folder / "out/comment.md").read_text()
        self.assertTrue(text.startswith("### As accurate\n"))
        self.assertIn("### Not slower\n", text)
        self.assertEqual({path.name for path in (self.folder / "out").iterdir()},
                         {"old.json", "new.json", "accuracy.json", "speed.json", "comment.md"})
        self.script("tools/guard", program, "/bin/true", "out", *words, code=2)
        self.script("tools/guard", program, code=2)


class OtherTools(InFolder):
    def test_export_writes_custom_smaller_is_better(self):
        path = self.folder / "new.json"
        self.ok("sweep", *PLAN, "--json", path)
        entries = json.loads(self.ok("export", path).stdout)
        self.assertEqual(len(entries), 4 * 2)
        for entry in entries:
            self.assertEqual(set(entry), {"name", "unit", "value", "range", "extra"})
            self.assertGreater(entry["value"], 0)
        self.fails("export", path, "--to", "csv", says="--to 'csv'")

    def test_doctor_says_what_times_are_worth(self):
        done = self.ok("doctor")
        for word in ("governor", "turbo", "load", "SMT", "quota", "clock", "noise",
                     "ratios of rows in one run"):
            self.assertIn(word, done.stdout)
        self.assertNotIn("\033", done.stdout)
        self.assertEqual([line for line in done.stdout.splitlines() if len(line) > 100], [])
        diagnosis = json.loads(self.ok("doctor", "--json", "-").stdout)
        self.assertGreaterEqual(diagnosis["noise_floor"], diagnosis["noise_typical"])
        for symptom in itertools.chain(diagnosis["symptoms"], diagnosis["trust"]):
            self.assertIn(symptom["trust"], ("good", "care", "bad"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
