"""definite reproduce, from outside: python3 reproduce_test.py DEFINITE [unittest's]"""

import copy
import json
import pathlib
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
        for words, named in ((("shi-kim-2024",), "shi-kim-2024"), ((), "paper"),
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


class Published(unittest.TestCase):
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
            self.assertEqual({row["count"] for row in result["rows"]}, {10**7})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
