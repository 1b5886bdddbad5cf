"""definite reproduce, from outside: python3 reproduce_test.py DEFINITE [unittest's]"""

import copy
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import jsonschema

PROGRAM = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parent.parent
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "results/schema.json").read_text()))
PAPER = "shi-kim-2023"
ACCURACY = "collision-accuracy"
STUDY = "first-study"
SPEED, OVERHEAD = slice(0, 5), slice(5, 10)  # of the claims: one for each row of Table 1


def run(*words):
    return subprocess.run([PROGRAM, "reproduce", *words], capture_output=True, text=True,
                          timeout=300, check=False)


class Reproduce(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.json, cls.markdown = (pathlib.Path(cls.folder.name) / f for f in ("r.json", "r.md"))
        cls.done = run(PAPER, "--count", "2000", "--json", cls.json, "--markdown", cls.markdown)
        cls.result = json.loads(cls.json.read_text())

    def judged(self, change):
        """The result after a change to its rows, with claims judged anew."""
        result = copy.deepcopy(self.result)
        change({row["kernel"]: row for row in result["rows"]})
        changed = pathlib.Path(self.folder.name) / "changed.json"
        changed.write_text(json.dumps(result))
        done = run(PAPER, "--from", changed, "--json", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def verdicts(self, change, claims):
        return {claim["verdict"] for claim in self.judged(change)["claims"][claims]}

    def test_it_ends_well_and_its_result_validates(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        VALIDATOR.validate(self.result)
        self.assertEqual(self.result["paper"], PAPER)
        self.assertEqual({row["distribution"] for row in self.result["rows"]}, {"paper"})
        self.assertEqual({row["count"] for row in self.result["rows"]}, {2000})

    def test_it_times_all_pairs_and_active_pairs(self):
        for row in self.result["rows"]:
            self.assertEqual([timing["pairs"] for timing in row["timing"]], ["all", "active"])

    def test_the_tables_are_the_same_on_the_terminal_in_the_file_and_from_the_json(self):
        self.assertEqual(self.done.stdout, self.markdown.read_text())
        self.assertEqual(run(PAPER, "--from", self.json).stdout, self.done.stdout)
        self.assertEqual([line for line in self.done.stdout.splitlines() if len(line) > 100], [])

    def test_the_published_numbers_stand_in_the_table(self):
        for cell in ("88.48", "12.31", "18.55", "84.30", "8.78", "12.29", "7.19", "4.51"):
            self.assertIn(f" {cell} |", self.done.stdout)

    def test_a_filter_as_fast_as_published_is_reproduced_and_a_slower_one_is_not(self):
        def set_ratio(filters, value):
            def change(rows):
                for name, row in rows.items():
                    for timing in row["timing"]:
                        if name.endswith(filters):
                            timing["ratio_to"]["numeric"] = dict.fromkeys(
                                ("median", "minimum", "low", "high"), value)
            return change

        frame, both = ("analytic_frame/f64",), ("analytic_frame/f64", "analytic/f64")
        self.assertEqual(self.verdicts(set_ratio(frame, 7.3), SPEED), {"reproduced"})
        self.assertEqual(self.verdicts(set_ratio(both, 4.4), SPEED), {"not reproduced"})

        def slow_through_the_frame(rows):
            set_ratio(both, 8.0)(rows)
            set_ratio(frame, 4.4)(rows)
        self.assertEqual(self.verdicts(slow_through_the_frame, SPEED), {"qualified"})

    def test_a_filter_that_costs_more_over_gauss_newton_is_not_reproduced(self):
        def set_overhead(value):
            def change(rows):
                for row in rows.values():
                    for timing in row["timing"]:
                        timing["ratio_to"]["gauss_newton_frame"] = dict.fromkeys(
                            ("median", "minimum", "low", "high"), 1 / value)
            return change

        self.assertEqual(self.verdicts(set_overhead(1.05), OVERHEAD), {"qualified"})
        self.assertEqual(self.verdicts(set_overhead(2.0), OVERHEAD), {"not reproduced"})

    def test_one_matrix_that_is_not_psd_refutes_the_claim(self):
        def spoil(rows):
            rows["collision/edge_edge/hybrid/quadratic/analytic/f64"]["verdicts"]["non_psd"] = 1
        claims = self.judged(spoil)["claims"]
        found = [c["verdict"] for c in claims if "positive semidefinite" in c["claim"]]
        self.assertEqual(found, ["not reproduced"])

    def test_without_timing_no_claim_of_speed_is_reproduced(self):
        def forget(rows):
            for row in rows.values():
                row["timing"] = []
        self.assertEqual(self.verdicts(forget, slice(0, 10)), {"not reproduced"})

    def test_bad_input_is_named(self):
        lacking = pathlib.Path(self.folder.name) / "lacking.json"
        lacking.write_text(json.dumps({**self.result, "rows": self.result["rows"][1:]}))
        other = pathlib.Path(self.folder.name) / "other.json"
        other.write_text('{"schema": "definite/1"}')
        for words, named in ((("shi-kim-2024",), "shi-kim-2024"), ((), "plan"),
                             (("shi-kim-2024",), "collision-accuracy "),
                             ((PAPER, "--kernels", "*/none/f64"), "need all their rows"),
                             ((PAPER, "--from", "no/such.json"), "no/such.json"),
                             ((PAPER, "--from", str(other)), str(other)),
                             ((PAPER, "--from", str(lacking)), "lacks the row")):
            with self.subTest(words=words):
                done = run(*words)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(named, done.stderr)
                self.assertEqual(done.stdout, "")

    def test_help_has_examples_within_100_columns(self):
        done = run("--help")
        self.assertIn("Examples:", done.stdout)
        self.assertEqual([line for line in done.stdout.splitlines() if len(line) > 100], [])

    def test_interrupted_it_writes_what_is_complete(self):
        file = pathlib.Path(self.folder.name) / "partial.json"
        with subprocess.Popen([PROGRAM, "reproduce", PAPER, "--count", "1e8", "--json", file],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        result = json.loads(file.read_text())
        VALIDATOR.validate(result)
        self.assertTrue(result["partial"])
        self.assertEqual({claim["verdict"] for claim in result["claims"]}, {"not reproduced"})

    def test_a_filter_that_is_the_projection_reproduces_that_claim(self):
        def set_median(median):
            def change(rows):
                for name, row in rows.items():
                    if name.endswith("/analytic/f64"):
                        row["accuracy"]["distance"]["median"] = median
            return change

        for median, verdict in ((1e-15, "reproduced"), (0.2, "qualified"),
                                (5.0, "not reproduced")):
            claims = self.judged(set_median(median))["claims"]
            self.assertEqual([c["verdict"] for c in claims if "numerical projection" in c["claim"]],
                             [verdict])


class Accuracy(unittest.TestCase):
    """The table of all collision energies and filters, of two small primitives."""

    WORDS = (ACCURACY, "--kernels", "collision/vertex_edge/*/quadratic/*", "--kernels",
             "collision/vertex_vertex/*/log_barrier/*", "--kernels", "strand/*", "--count", "3000")

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.json, cls.markdown = (pathlib.Path(cls.folder.name) / f for f in ("r.json", "r.md"))
        cls.done = run(*cls.WORDS, "--json", cls.json, "--markdown", cls.markdown)
        cls.result = json.loads(cls.json.read_text())

    def test_it_ends_well_and_its_result_validates(self):
        self.assertEqual((self.done.returncode, self.done.stderr), (0, ""))
        VALIDATOR.validate(self.result)
        self.assertEqual(self.result["paper"], ACCURACY)
        self.assertNotIn("claims", self.result)

    def test_it_has_each_filter_once_over_each_distribution_untimed(self):
        filters = ("absolute", "absolute_numeric", "analytic", "blend_half", "gauss_newton",
                   "nearest", "none", "numeric", "split")
        energies = ("collision/vertex_edge/unsigned/quadratic",
                    "collision/vertex_vertex/unsigned/log_barrier")
        rows = [(row["kernel"], row["distribution"]) for row in self.result["rows"]]
        self.assertEqual(sorted(rows), sorted(
            (f"{energy}/{name}/f64", distribution) for energy in energies for name in filters
            for distribution in ("active", "normal", "paper")))
        self.assertEqual({len(row["timing"]) for row in self.result["rows"]}, {0})
        self.assertEqual({row["count"] for row in self.result["rows"]}, {3000})

    def test_its_result_is_brief_and_as_a_sweep_finds_it(self):
        row = self.result["rows"][0]
        done = subprocess.run([PROGRAM, "sweep", "--kernels", row["kernel"], "--distribution",
                               row["distribution"], "--count", "3000", "--no-timing", "--json", "-"],
                              capture_output=True, text=True, check=True)
        other = json.loads(done.stdout)["rows"][0]
        self.assertEqual(row["checksum"], other["checksum"])
        for name in ("distance", "excess"):
            figure, full = row["accuracy"][name], other["accuracy"][name]
            for key in ("histogram",):
                self.assertIsNone(figure[key])
            self.assertEqual([figure["max"][key] for key in ("x", "p")], [None, None])
            self.assertEqual(figure["max"]["index"], full["max"]["index"])
            self.assertEqual(figure["count"], full["count"])
            # Up to the rounding of P, which is another row's where `nearest` is judged itself.
            for key in ("median", "p99", "p999"):
                self.assertAlmostEqual(figure[key], full[key], delta=1e-12 * abs(full[key]))
        self.assertIsNone(row["accuracy"]["rounding"])
        lines = self.json.read_text().splitlines()
        self.assertEqual(sum('"kernel"' in line for line in lines), len(self.result["rows"]))

    def test_the_tables_are_the_same_on_the_terminal_in_the_file_and_from_the_json(self):
        self.assertEqual(self.done.stdout, self.markdown.read_text())
        again = pathlib.Path(self.folder.name) / "again.json"
        done = run(ACCURACY, "--from", self.json, "--json", again)
        self.assertEqual(done.stdout, self.done.stdout)
        self.assertEqual(again.read_text(), self.json.read_text())
        self.assertEqual([line for line in self.done.stdout.splitlines() if len(line) > 100], [])

    def cells(self, heading, line):
        """The cells of a line of the table under a heading."""
        text = self.done.stdout.split(f"\n{heading}\n")[1]
        row = next(row for row in text.splitlines() if row.startswith(f"| {line} "))
        return [cell.strip() for cell in row.strip("|").split("|")]

    def of(self, kernel, distribution):
        return next(row for row in self.result["rows"]
                    if (row["kernel"], row["distribution"]) == (kernel, distribution))

    def test_the_numbers_stand_where_they_belong(self):
        energy = "collision/vertex_edge/unsigned/quadratic"
        row = self.of(energy + "/gauss_newton/f64", "active")
        accuracy = row["accuracy"]
        found = self.cells(f"#### {energy}", "gauss_newton")
        for cell, value in zip(found[1:4], (accuracy["distance"]["median"],
                                            accuracy["distance"]["p99"],
                                            accuracy["distance"]["max"]["value"])):
            self.assertAlmostEqual(float(cell) / value, 1, delta=0.06)
        self.assertEqual(int(found[4]), accuracy["distance"]["max"]["index"])
        self.assertAlmostEqual(float(found[5]) / accuracy["excess"]["median"], 1, delta=0.06)
        self.assertEqual(found[8], "0")
        none = self.of(energy + "/none/f64", "active")
        self.assertGreater(none["verdicts"]["non_psd"], 1000)
        self.assertEqual(self.cells(f"#### {energy}", "none")[8],
                         str(none["verdicts"]["non_psd"]))
        median, p99 = self.cells("#### `active`", "unsigned/quadratic")[1].split("/")
        self.assertAlmostEqual(float(median) / accuracy["distance"]["median"], 1, delta=0.06)
        self.assertAlmostEqual(float(p99) / accuracy["distance"]["p99"], 1, delta=0.06)

    def test_a_matrix_that_is_not_finite_counts_as_not_psd(self):
        result = copy.deepcopy(self.result)
        row = next(row for row in result["rows"] if row["filter"] == "split")
        row["verdicts"]["non_finite"] = 77
        row["verdicts"]["non_psd"] = 11
        changed = pathlib.Path(self.folder.name) / "changed.json"
        changed.write_text(json.dumps(result))
        self.assertIn(" 88 |", run(ACCURACY, "--from", changed).stdout)

    def test_an_energy_and_a_filter_that_it_does_not_know_get_their_place(self):
        result = copy.deepcopy(self.result)
        row = copy.deepcopy(self.of("collision/vertex_edge/unsigned/quadratic/split/f64", "paper"))
        row.update(kernel="collision/edge_edge/bent/quartic/shift/f64", filter="shift",
                   energy="collision/edge_edge/bent/quartic")
        result["rows"].append(row)
        changed = pathlib.Path(self.folder.name) / "changed.json"
        changed.write_text(json.dumps(result))
        text = run(ACCURACY, "--from", changed).stdout
        for found in ("\n#### collision/edge_edge/bent/quartic\n", "\n| bent/quartic ",
                      "\n| shift "):
            self.assertIn(found, text)
        of_paper = text.split("#### `paper`")[1]
        self.assertLess(of_paper.index("**edge_edge**"), of_paper.index("**vertex_edge**"))

    def test_rows_that_the_plan_does_not_have_are_rejected(self):
        for glob in ("strand/*", "*/analytic_frame/f64", "*/analytic/f64x8"):
            done = run(ACCURACY, "--kernels", glob, "--count", "8")
            self.assertEqual((done.returncode, done.stdout), (2, ""), glob)
            self.assertIn("has none of these rows", done.stderr)

    def test_interrupted_it_writes_what_is_complete(self):
        file = pathlib.Path(self.folder.name) / "partial.json"
        with subprocess.Popen([PROGRAM, "reproduce", *self.WORDS[:-1], "1e8", "--json", file],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        result = json.loads(file.read_text())
        VALIDATOR.validate(result)
        self.assertTrue(result["partial"])
        self.assertEqual(len(result["rows"]), len(self.result["rows"]))
        self.assertGreater(max(row["count"] for row in result["rows"]), 0)


class Study(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        done = run(STUDY, "--count", "4000", "--json", "-")
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        cls.result = json.loads(done.stdout)
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)

    def judged(self, factor, key="median"):
        """The verdicts after a change of every distance."""
        result = copy.deepcopy(self.result)
        for row in result["rows"]:
            row["accuracy"]["distance"][key] *= factor
        changed = pathlib.Path(self.folder.name) / "changed.json"
        changed.write_text(json.dumps(result))
        done = run(STUDY, "--from", changed, "--json", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        return [claim["verdict"] for claim in json.loads(done.stdout)["claims"]]

    def test_its_result_validates_and_has_the_sides(self):
        VALIDATOR.validate(self.result)
        self.assertEqual({row.get("set", {}).get("side", 0) for row in self.result["rows"]},
                         {0, 1, -1})
        self.assertEqual(len(self.result["claims"]), len(self.result["rows"]))

    def test_most_distances_agree_and_a_tenth_more_or_less_does_not(self):
        self.assertGreater(self.judged(1).count("reproduced"), 60)
        for factor in (0.85, 1.15):
            self.assertGreater(self.judged(factor).count("not reproduced"), 60)

    def test_a_p95_beyond_our_p99_is_no_agreement(self):
        self.assertGreater(self.judged(0.2, "p99").count("qualified"), 40)

    def test_its_table_fits_100_columns(self):
        text = run(STUDY, "--from", self.saved()).stdout
        self.assertEqual([line for line in text.splitlines() if len(line) > 100], [])
        self.assertIn("| normal, outside: analytic ", text)

    def saved(self):
        file = pathlib.Path(self.folder.name) / "saved.json"
        file.write_text(json.dumps(self.result))
        return file


class Published(unittest.TestCase):
    COUNTS = {PAPER: 10**7, ACCURACY: 10**6, STUDY: 10**6}

    def test_what_readme_and_docs_quote_is_generated_from_the_published_results(self):
        done = subprocess.run([ROOT / "tools/tables", "--check", "--program", PROGRAM],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_published_results_validate_and_are_whole(self):
        files = list((ROOT / "results/published").glob("*.json"))
        self.assertTrue(files)
        for file in files:
            result = json.loads(file.read_text())
            VALIDATOR.validate(result)
            self.assertFalse(result["partial"])
            if file.stem.startswith("speed"):
                self.assertEqual({job["count"] for job in result["speed"]["jobs"]}, {10**7})
                self.assertEqual({row["rounds"] for row in result["speed"]["rows"]}, {31})
                continue
            if file.stem.startswith("scenes"):
                self.assertEqual(result["scenes"]["starts"], 20 if "-map-" in file.stem else 100)
                continue
            self.assertEqual({row["count"] for row in result["rows"]}, {self.COUNTS[file.stem]})
            self.assertLess(file.stat().st_size, 1.5e6)

    def test_the_accuracy_of_every_collision_energy_is_published(self):
        names = subprocess.run([PROGRAM, "list", "--kernels", "collision/*/f64"],
                               capture_output=True, text=True, check=True).stdout.split()
        # Not the baselines that a few energies have, and not one filter twice.
        names = {name for name in names
                 if not re.search(r"_frame/|_printed/|/(numeric|ql|jacobi|shift)_|/vertex_blocks/",
                                  name)}
        result = json.loads((ROOT / f"results/published/{ACCURACY}.json").read_text())
        for distribution in ("active", "normal", "paper"):
            self.assertEqual({row["kernel"] for row in result["rows"]
                              if row["distribution"] == distribution}, names)
        page = (ROOT / "docs/collision-filters.md").read_text()
        for energy in {row["energy"] for row in result["rows"]}:
            self.assertEqual(page.count(f"\n#### {energy}\n"), 1)
        self.assertEqual([line for line in page.splitlines() if len(line) > 100], [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
