"""Advice for configurations on record: python3 advise_test.py DEFINITE [unittest's]"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema

PROGRAM = os.path.abspath(sys.argv[1])
ROOT = pathlib.Path(__file__).resolve().parent.parent
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "results/schema.json").read_text()))
TIMEOUT = 120
EDGES = "collision/edge_edge/signed/quadratic"
HEAD = "x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3\n"
# Two crossing edges, apart by the last number.
CROSSING = "0,0,0,1,0,0,0.25,-0.5,{0},0.75,0.5,{0}\n"


def run(*words, **options):
    return subprocess.run([PROGRAM, *words], check=False, text=True, timeout=TIMEOUT,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


def drawn(count, stencil="edge_edge", head="", distribution="active"):
    """Lines of CSV with configurations of a distribution, as replay shows them."""
    energy = f"collision/{stencil}/signed/quadratic"
    text = f"# stencil={stencil} {head}\n{HEAD}"
    for index in range(count):
        done = run("replay", "--kernel", f"{energy}/gauss_newton/f64", "--index", str(index),
                   "--distribution", distribution, "--json")
        text += ",".join(json.loads(done.stdout)["x"]) + "\n"
    return text


class Recorded(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, text, name="contacts.csv"):
        path = self.folder / name
        path.write_text(text)
        return str(path)

    def sweep(self, path, *words):
        done = run("sweep", "--no-timing", "--json", "-", "--distribution", path, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def refused(self, text, *wanted, name="contacts.csv", words=()):
        """Advice and sweep refuse a file, for a reason, and write nothing."""
        path = self.file(text, name)
        out = self.folder / "out.json"
        for command in (["advise", path], ["sweep", "--distribution", path]):
            done = run(*command, "--json", str(out), *words)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertEqual(done.stdout, "")
            for what in (path, *wanted):
                self.assertIn(what, done.stderr)
            self.assertFalse(out.exists())


class AsDistribution(Recorded):
    def test_a_file_of_drawn_configurations_gives_the_bits_of_the_drawing(self):
        path = self.file(drawn(20, head="eps=0.1"))
        kernels = ["--kernels", EDGES + "/*"]
        fresh = run("sweep", "--no-timing", "--json", "-", "--count", "20", *kernels)
        self.assertEqual({r["kernel"]: r["checksum"] for r in self.sweep(path, *kernels)["rows"]},
                         {r["kernel"]: r["checksum"] for r in json.loads(fresh.stdout)["rows"]})

    def test_both_forms_say_the_same(self):
        csv = self.file("# stencil=edge_edge k=3\n" + HEAD.strip() + ",eps\n"
                        + CROSSING.format(0.25).strip() + ",1\n"
                        + CROSSING.format(-0.125).strip() + ",0.5\n")
        lines = self.file('{"stencil": "edge_edge", "k": 3}\n'
                          '{"x": [0,0,0,1,0,0,0.25,-0.5,0.25,0.75,0.5,0.25], "eps": 1}\n\n'
                          '{"eps": 0.5, "x": [0,0,0,1,0,0,0.25,-0.5,-0.125,0.75,0.5,-0.125]}\n',
                          "contacts.jsonl")
        first, second = self.sweep(csv), self.sweep(lines)
        self.assertEqual(first["plan"]["recorded"], second["plan"]["recorded"])
        self.assertEqual([r["checksum"] for r in first["rows"]],
                         [r["checksum"] for r in second["rows"]])

    def test_columns_may_stand_in_any_order_and_numbers_be_hex(self):
        plain = self.file("# stencil=edge_edge\n" + HEAD + CROSSING.format(0.25))
        turned = self.file("# of a test: stencil=edge_edge\r\n\r\n"
                           "z3,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,x0\r\n"
                           "0x1p-2, 0 ,0,1,0,0,.25,-0x1p-1,2.5e-1,0.75,0.5,0\r\n", "turned.csv")
        self.assertEqual(self.sweep(plain)["plan"]["recorded"],
                         self.sweep(turned)["plan"]["recorded"])

    def test_what_is_set_overrules_the_file_which_overrules_the_default(self):
        path = self.file("# stencil=edge_edge eps=0.5\n" + HEAD + CROSSING.format(0.25))
        def active(*words):
            return self.sweep(path, "--kernels", EDGES + "/none/f64", *words)["rows"][0]["active"]
        self.assertEqual((active(), active("--set", "eps=0.125")), (1, 0))
        path = self.file("# stencil=edge_edge eps=0.125\n" + HEAD + CROSSING.format(0.25), "b.csv")
        self.assertEqual(active(), 0)

    def test_what_lies_outside_the_domain_is_counted_not_mirrored(self):
        path = self.file("# stencil=edge_edge eps=1\n" + HEAD + CROSSING.format(0.25)
                         + CROSSING.format(-0.25))
        row = self.sweep(path, "--kernels", "collision/edge_edge/signed/log_barrier/none/f64")
        self.assertEqual((row["rows"][0]["active"], row["rows"][0]["out_of_domain"]), (1, 1))

    def test_a_count_goes_round_and_all_is_the_default(self):
        path = self.file("# stencil=edge_edge eps=1\n" + HEAD + CROSSING.format(0.25)
                         + CROSSING.format(2) + CROSSING.format(-0.25))
        kernels = ["--kernels", EDGES + "/none/f64"]
        self.assertEqual(self.sweep(path, *kernels)["rows"][0]["count"], 3)
        row = self.sweep(path, *kernels, "--count", "7")["rows"][0]
        self.assertEqual((row["count"], row["active"]), (7, 5))

    def test_only_rows_of_its_stencil_run(self):
        path = self.file("# stencil=edge_edge\n" + HEAD + CROSSING.format(0.25))
        self.assertEqual({r["energy"].split("/")[1] for r in self.sweep(path)["rows"]},
                         {"edge_edge"})

    def test_shards_merge_and_a_changed_file_is_noticed(self):
        lines = [CROSSING.format(z / 1000) for z in range(1, 700)]
        path = self.file("# stencil=edge_edge eps=1\n" + HEAD + "".join(lines))
        kernels = ["--kernels", EDGES + "/split/*"]
        parts = [str(self.folder / f"{i}.json") for i in (1, 2)]
        for i, part in enumerate(parts):
            run("sweep", "--no-timing", "--distribution", path, *kernels, "--shard", f"{i + 1}/2",
                "--json", part)
        whole = self.folder / "whole.json"
        done = run("merge", *parts, "--json", str(whole))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(whole.read_text())["rows"][0]["count"], 699)
        VALIDATOR.validate(json.loads(whole.read_text()))
        self.file("# stencil=edge_edge eps=1\n" + HEAD + "".join(lines[1:] + lines[:1]))
        done = run("merge", *parts, "--json", str(whole))
        self.assertEqual(done.returncode, 2)
        self.assertIn("contacts.csv: the file is not the one that was read then", done.stderr)


class BadFiles(Recorded):
    GOOD = "# stencil=edge_edge\n" + HEAD + CROSSING.format(0.25)

    def test_an_empty_file(self):
        self.refused("", "it is empty")
        self.refused("\n\n", "it is empty")

    def test_no_configurations(self):
        self.refused("# stencil=edge_edge\n", ":1: ", "expected a head")
        self.refused("# stencil=edge_edge\n" + HEAD, "it has no configurations")
        self.refused('{"stencil": "edge_edge"}', ":1: ", "expected configurations",
                     name="c.jsonl")

    def test_too_few_or_too_many_numbers(self):
        self.refused(self.GOOD + "1,2,3\n", ":4: 3 columns; expected 12")
        self.refused(self.GOOD + "\n" + CROSSING.format(1).strip() + ",1\n",
                     ":5: 13 columns; expected 12")
        self.refused('{"stencil": "edge_edge", "x": [1, 2]}', ":1: x has 2 numbers; expected 12",
                     name="c.jsonl")
        self.refused('{"stencil": "edge_edge", "k": 1}\n{"eps": 1}', ":2: x has 0 numbers",
                     name="c.jsonl")

    def test_what_is_no_finite_number(self):
        for word in ("nan", "inf", "-inf", "1e999", "", "1.5x", "--1", "0x", "1 2"):
            with self.subTest(word=word):
                self.refused(self.GOOD + CROSSING.format(word),
                             f":4: z2 is '{word}'; expected a finite number")
        numbers = [0] * 11
        for word in ("null", '"1"'):
            self.refused(json.dumps({"stencil": "edge_edge"}) + '\n{"x": '
                         + json.dumps(numbers)[:-1] + f", {word}]}}\n",
                         f":2: x is {word}; expected a number", name="c.jsonl")
        for word in ("NaN", "1e999"):
            self.refused(json.dumps({"stencil": "edge_edge"}) + '\n{"x": '
                         + json.dumps(numbers)[:-1] + f", {word}]}}\n", ":2: not a JSON object",
                         name="c.jsonl")

    def test_the_first_of_several_bad_lines_is_named(self):
        self.refused(self.GOOD * 1 + CROSSING.format(1) * 5000 + "1,2\n" * 5000, ":5004: 2 columns")

    def test_mixed_kinds(self):
        self.refused("# stencil=edge_edge\n# stencil=vertex_face\n" + HEAD,
                     ":2: 'vertex_face' in a file of edge_edge; expected one stencil")
        self.refused(self.GOOD + "# stencil=vertex_face\n" + HEAD + CROSSING.format(1),
                     ":4: '# stencil=vertex_face' below the head; expected numbers")
        self.refused('{"stencil": "edge_edge", "x": [0,0,0,1,0,0,0,1,1,1,1,1]}\n'
                     '{"stencil": "vertex_face", "x": [0,0,0,1,0,0,0,1,1,1,1,1]}\n',
                     ":2: 'vertex_face' in a file of edge_edge", name="c.jsonl")

    def test_an_unknown_or_missing_stencil(self):
        self.refused("# stencil=edge_face\n" + HEAD, ":1: there is no stencil 'edge_face'",
                     "vertex_face")
        self.refused(HEAD + CROSSING.format(1), ":1: the stencil is not known; expected",
                     "# stencil=edge_edge")
        self.refused('{"x": [1]}', ":1: the stencil is not known", name="c.jsonl")

    def test_an_unknown_repeated_or_missing_column(self):
        self.refused("# stencil=edge_edge\n" + HEAD.strip() + ",epsilon\n",
                     ":2: no energy has a parameter 'epsilon'; there are k, eps")
        self.refused("# stencil=edge_edge eps=1\n" + HEAD.strip() + ",eps\n",
                     ":2: eps stands there twice")
        self.refused("# stencil=edge_edge\n" + HEAD.replace("z3", "x0"),
                     ":2: x0 stands there twice")
        self.refused("# stencil=edge_edge\n" + HEAD.replace(",z3", ""), ":2: the head lacks z3")
        self.refused("# stencil=edge_edge k=soft\n" + HEAD, ":1: k is 'soft'")

    def test_json_lines_that_differ_in_their_names(self):
        x = "[0,0,0,1,0,0,0,1,1,1,1,1]"
        first = '{"stencil": "edge_edge", "eps": 1, "x": ' + x + "}\n"
        self.refused(first + '{"x": ' + x + "}\n", ":2: 0 parameters; expected 1", name="c.jsonl")
        self.refused(first + '{"x": ' + x + ', "k": 1}\n', ":2: 'k'; expected the same names",
                     name="c.jsonl")
        for line in ("[1, 2]", "3", "null", '{"x": [1]} 2', '{"x": [1]'):
            self.refused(first + line + "\n", ":2: not a JSON object", name="c.jsonl")
        for line, wanted in (('{"x": 3}', "x is a number; expected an array"),
                             ('{"x": [[1]]}', "x is an array; expected a number"),
                             ('{"eps": true}', "eps is true; expected a number"),
                             ('{"eps": {"is": 1}}', "eps is an object; expected a number"),
                             ('{"stencil": 3}', "stencil is a number; expected a name")):
            self.refused(first + line + "\n", ":2: " + wanted, name="c.jsonl")

    def test_a_file_of_two_gigabytes(self):
        path = self.folder / "large.csv"
        with path.open("wb") as file:
            os.truncate(file.fileno(), 2_000_000_000)
        done = run("advise", str(path))
        self.assertEqual(done.returncode, 2)
        self.assertIn("large.csv: 2.0 GB; expected at most 1", done.stderr)

    def test_a_file_that_is_none(self):
        for path, wanted in (("nowhere.csv", "there is no such file"),
                             ("contacts.txt", "expected a .csv or .jsonl file"),
                             (str(self.folder), "expected a .csv or .jsonl file")):
            done = run("advise", path)
            self.assertEqual(done.returncode, 2)
            self.assertIn(wanted, done.stderr)


class Advice(Recorded):
    def advise(self, path, *words, code=0):
        done = run("advise", path, "--json", "-", *words)
        self.assertEqual(done.returncode, code, done.stderr)
        result = json.loads(done.stdout)
        VALIDATOR.validate(result)
        return result

    def costs(self, result):
        return {row["kernel"]: next(t["ns_per_hessian"]["median"] for t in row["timing"]
                                    if t["pairs"] == "active") for row in result["rows"]}

    def test_it_takes_the_cheapest_that_will_do(self):
        path = self.file(drawn(100, head="eps=0.1"))
        for tolerance in (0.05, 0.3, 10):
            with self.subTest(tolerance=tolerance):
                result = self.advise(path, "--tolerance", str(tolerance))
                costs = self.costs(result)
                good = [row["kernel"] for row in result["rows"]
                        if row["accuracy"]["distance"]["p99"] <= tolerance
                        and not any(row["verdicts"][v] for v in
                                    ("non_psd", "non_finite", "silent_zero", "inconsistent"))]
                advice = result["advice"]
                self.assertEqual(advice["chosen"], min(good, key=costs.get))
                self.assertIn("/".join(advice["chosen"].split("/")[-2:]), advice["reason"])
                self.assertEqual(sorted(advice["objections"]), sorted(set(costs) - set(good)))

    def test_a_tight_tolerance_leaves_the_projection(self):
        result = self.advise(self.file(drawn(100, head="eps=0.1")), "--tolerance", "1e-9")
        self.assertEqual(result["advice"]["chosen"], EDGES + "/nearest/f64x8")

    def test_its_statistics_are_those_of_a_sweep(self):
        path = self.file(drawn(60, stencil="vertex_face", head="eps=0.1"))
        advice = self.advise(path)
        swept = self.sweep(path, *(word for row in advice["rows"]
                                   for word in ("--kernels", row["kernel"])))
        self.assertEqual(len(advice["rows"]), 7)
        swept_rows = {row["kernel"]: row for row in swept["rows"]}
        for mine in advice["rows"]:
            its = swept_rows[mine["kernel"]]
            for row in (mine, its):  # of one run with its histograms, and one without
                for key in ("timing", "indefinite", "out_of_domain", "worst_cases",
                            "broken_promises"):
                    row.pop(key, None)
                for figure in row["accuracy"].values():
                    if isinstance(figure, dict):
                        figure.pop("histogram")
            self.assertEqual(mine, its)

    def test_it_tells_how_many_act_and_are_indefinite(self):
        path = self.file("# stencil=edge_edge eps=0.5\n" + HEAD + CROSSING.format(0.25)
                         + CROSSING.format(2) + CROSSING.format(-0.25) + CROSSING.format(0.125))
        shown = run("advise", path).stdout
        self.assertRegex(shown, r"\n  active +3  75 %\n")
        self.assertRegex(shown, r"\n  indefinite +3  100 % of the active\n")
        self.assertRegex(shown, r"\n  outside the domain +0  0 %\n")

    def test_it_finds_each_degenerate_family(self):
        ordinary = CROSSING.format(0.25)
        families = {
            "edge_angle": "0,0,0,1,0,0,0.25,-0.5e-6,{0},1.25,0.5e-6,{0}\n".format(0.25),
            "short_edge": "0,0,0,1e-6,0,0,0,-0.5,0.25,0,0.5,0.25\n",
            "touching": CROSSING.format(1e-7),
            "tiny": "0,0,0,1,0,0,0.25,-0.5,{0},0.75,0.5,{0}\n".format(-3e5),
            "far_foot": "0,0,0,1,0,0,2e5,-0.5,0.25,2e5,0.5,0.25\n",
        }
        for family, line in families.items():
            with self.subTest(family=family):
                path = self.file("# stencil=edge_edge eps=1\n" + HEAD + ordinary * 3 + line
                                 + ordinary, f"{family}.csv")
                advice = self.advise(path, "--tolerance", "1e9")["advice"]
                found = {d["family"]: d for d in advice["degeneracies"]}
                self.assertEqual(set(found), set(families))
                self.assertEqual((found[family]["count"], found[family]["line"]), (1, 6))
                self.assertLess(found[family]["smallest"], 1e-4)

    def test_it_finds_a_sliver_and_coincident_vertices(self):
        face = "0.3,0.3,-0.1,1,0,0,0,0,0,0,1,0\n"
        sliver = "0.3,0.3e-6,-0.1,1,0,0,0,0,0,0.5,1e-6,0\n"
        path = self.file("# stencil=vertex_face eps=1 side=-1\n" + HEAD + face + sliver)
        found = {d["family"]: d for d in
                 self.advise(path, "--tolerance", "1e9")["advice"]["degeneracies"]}
        self.assertEqual((found["sliver"]["count"], found["sliver"]["line"]), (1, 4))
        point = self.file("# stencil=vertex_face eps=1\n" + HEAD + face
                          + ",".join(["0.5"] * 12) + "\n", "point.csv")
        result = self.advise(point, "--tolerance", "1e9")
        found = {d["family"]: d for d in result["advice"]["degeneracies"]}
        self.assertEqual((found["short_edge"]["smallest"], found["short_edge"]["line"]), (0, 4))

    def test_without_anything_active_there_is_no_advice(self):
        path = self.file("# stencil=edge_edge eps=0.1\n" + HEAD + CROSSING.format(0.25))
        result = self.advise(path, code=1)
        self.assertIsNone(result["advice"]["chosen"])
        self.assertIn("None of the configurations is active", result["advice"]["reason"])

    def test_the_energy_can_be_chosen_and_a_wrong_one_is_rejected_with_those_there_are(self):
        path = self.file("# stencil=edge_edge eps=1\n" + HEAD + CROSSING.format(0.25) * 9)
        result = self.advise(path, "--energy", "hybrid/log_barrier")
        self.assertEqual({row["energy"] for row in result["rows"]},
                         {"collision/edge_edge/hybrid/log_barrier"})
        done = run("advise", path, "--energy", "signed/barrier")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--energy 'signed/barrier': expected one of those for edge_edge: ",
                      done.stderr)
        self.assertIn("signed/log_barrier", done.stderr)

    def test_bad_tolerances_are_rejected(self):
        path = self.file("# stencil=edge_edge eps=1\n" + HEAD + CROSSING.format(0.25))
        for text in ("0", "-1", "much", "1e-13", "inf", "nan"):
            done = run("advise", path, "--tolerance", text)
            self.assertEqual(done.returncode, 2, text)
            self.assertIn(f"--tolerance '{text}': expected a relative distance", done.stderr)

    def test_other_stencils_have_their_unsigned_energy(self):
        path = self.file("# stencil=vertex_edge eps=1\nx0,y0,z0,x1,y1,z1,x2,y2,z2\n"
                         "0.3,0,0.1,0,0,0,1,0,0\n")
        result = self.advise(path)
        self.assertEqual({row["energy"] for row in result["rows"]},
                         {"collision/vertex_edge/unsigned/quadratic"})

    def test_its_table_fits_100_columns(self):
        shown = run("advise", self.file(drawn(30, head="eps=0.1"))).stdout
        self.assertEqual([line for line in shown.splitlines() if len(line) > 100], [])
        self.assertIn("distance to nearest", shown)


class Example(Recorded):
    def test_the_exporter_writes_what_is_read(self):
        program = self.folder / "export"
        subprocess.run(["g++", "-Wall", "-Wextra", "-Werror", "-o", str(program),
                        str(ROOT / "docs/examples/export_contacts.cpp")], check=True)
        subprocess.run([str(program)], check=True, cwd=self.folder)
        done = run("advise", "contacts.csv", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 configurations", done.stdout)

    def test_the_page_shows_files_that_are_read(self):
        page = (ROOT / "docs/advice.md").read_text()
        blocks = re.findall(r"^```(\w*)\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
        csv, lines = (text for language, text in blocks if not language)
        recorded = [self.sweep(self.file(text, name))["plan"]["recorded"]
                    for text, name in ((csv, "a.csv"), (lines, "a.jsonl"))]
        self.assertEqual(recorded[0]["configurations"], 1)
        self.assertEqual(recorded[0], recorded[1])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
