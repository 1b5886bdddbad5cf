"""definite fuzz, from outside."""

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
DEFINITE, BROKEN = sys.argv[1:3]
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "results/schema.json").read_text()))
ENERGY = "collision/vertex_face/signed/quadratic"
SMALL = ("--kernels", ENERGY + "/analytic/*", "--kernels", ENERGY + "/numeric/*",
         "--families", "at_eps", "--families", "sliver", "--count", "1000")


def run(*words, program=DEFINITE):
    return subprocess.run([program, *words], capture_output=True, text=True, check=False,
                          timeout=120)


class Fuzz(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fuzz(self, *words, code=0, program=DEFINITE):
        path = self.folder / "fuzz.json"
        done = run("fuzz", "--json", str(path), *words, program=program)
        self.assertEqual(done.returncode, code, done.stderr)
        result = json.loads(path.read_text())
        VALIDATOR.validate(result)
        for cell in result["fuzz"]["cells"]:
            for row in cell["rows"]:  # of one filter, also where nothing is active
                self.assertEqual(len({name.rsplit("/", 1)[0] for name in row["kernels"]}), 1)
        return result["fuzz"], done

    def test_every_cell_is_seen(self):
        fuzz, done = self.fuzz(*SMALL)
        self.assertEqual(len(fuzz["cells"]), 2 * 17)
        self.assertEqual(fuzz["all_cells"], 2 * 17)
        self.assertEqual({(c["family"], c["decade"]) for c in fuzz["cells"]},
                         {(f, d) for f in ("at_eps", "sliver") for d in range(17)})
        self.assertGreaterEqual(sum(c["count"] for c in fuzz["cells"]), 1000)
        self.assertEqual(fuzz["findings"], [])
        for cell in fuzz["cells"]:
            rows = [kernel for row in cell["rows"] for kernel in row["kernels"]]
            self.assertEqual(sorted(rows), [f"{ENERGY}/{name}" for name in
                                            ("analytic/f64", "analytic/f64x8", "numeric/f64")])
        self.assertIn("analytic", done.stdout)
        self.assertLessEqual(max(map(len, done.stdout.splitlines())), 100)

    def test_threads_and_shards_see_the_same(self):
        cells = [self.fuzz(*SMALL, "--threads", n)[0]["cells"] for n in ("1", "3")]
        self.assertEqual(cells[0], cells[1])
        parts = [self.fuzz(*SMALL, "--shard", f"{i}/2")[0]["cells"] for i in (1, 2)]
        self.assertEqual(sorted(map(str, parts[0] + parts[1])), sorted(map(str, cells[0])))

    def test_a_summary_says_the_same_without_cells(self):
        self.fuzz(*SMALL)
        whole, summary = self.folder / "fuzz.json", self.folder / "summary.json"
        self.assertEqual(run("fuzz", "--from", str(whole), "--json", str(summary)).returncode, 0)
        result = json.loads(summary.read_text())
        VALIDATOR.validate(result)
        self.assertEqual(result["fuzz"]["cells"], [])
        pages = [run("fuzz", "--from", str(path)).stdout for path in (whole, summary)]
        self.assertEqual(*pages)
        self.assertIn("## sliver", pages[0])
        for fate in result["fuzz"]["summary"]["fates"]:
            self.assertEqual(sum(fate["verdicts"].values()), fate["failed"])

    def test_another_seed_sees_others(self):
        one, other = (self.fuzz(*SMALL, "--seed", s)[0]["cells"] for s in "12")
        self.assertNotEqual([c["rows"] for c in one], [c["rows"] for c in other])

    def test_what_was_killed_is_resumed(self):
        path = self.folder / "kept.json"
        words = [DEFINITE, "fuzz", *SMALL[:-2], "--count", "3e5", "--resume", "--json", str(path)]
        # The part of another shard stands for what an earlier run kept.
        self.assertEqual(run(*words[1:], "--shard", "1/2").returncode, 0)
        kept = json.loads(path.read_text())
        self.assertTrue(kept["partial"])
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as killed:
            time.sleep(0.3)
            killed.kill()
        self.assertEqual(json.loads(path.read_text()), kept)
        self.assertEqual(run(*words[1:]).returncode, 0)
        whole = json.loads(path.read_text())
        self.assertFalse(whole["partial"])
        straight, _ = self.fuzz(*SMALL[:-2], "--count", "3e5")
        self.assertEqual(whole["fuzz"]["cells"], straight["cells"])
        done = run(*words[1:], "--seed", "43")
        self.assertEqual(done.returncode, 2)
        self.assertIn("its seed are others: 42", done.stderr)

    def test_interrupted_it_writes_what_is_complete(self):
        path = self.folder / "partial.json"
        with subprocess.Popen([DEFINITE, "fuzz", *SMALL[:-2], "--count", "1e8", "--json", str(path)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
            time.sleep(2)
            running.send_signal(signal.SIGINT)
            _, errors = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 130, errors)
        result = json.loads(path.read_text())
        VALIDATOR.validate(result)
        self.assertTrue(result["partial"])

    def test_a_broken_filter_is_found_and_its_line_replays(self):
        corpus = self.folder / "found"
        corpus.mkdir()
        fuzz, done = self.fuzz("--families", "at_eps", "--count", "500", "--corpus", str(corpus),
                               program=BROKEN, code=1)
        finding = next(f for f in fuzz["findings"] if f["what"] == "psd")
        self.assertIn(f"{ENERGY}/analytic/f64", finding["kernels"])
        command = next(line for line in done.stderr.splitlines() if "definite replay" in line)
        self.assertEqual(run(*command.split()[1:], program=BROKEN).returncode, 1)
        lines = sorted(corpus.iterdir())
        self.assertIn("collision-vertex_face-signed-quadratic-at_eps-psd.csv",
                      [p.name for p in lines])
        for path in lines:
            done = run("replay", "--kernel", f"{ENERGY}/analytic/f64", "--distribution", str(path),
                       "--index", "0", program=BROKEN)
            self.assertEqual(done.returncode, 1, path.read_text())

    def test_a_climb_goes_higher_than_draws(self):
        path = self.folder / "largest.json"
        words = ("fuzz", "--climb", "distance", "--kernels", ENERGY + "/analytic/f64", "--kernels",
                 ENERGY + "/nearest/f64", "--families", "deep", "--families", "sliver",
                 "--json", str(path))
        heights = []
        for more in (("--count", "20000"), ("--count", "20000", "--threads", "1")):
            done = run(*words, *more)
            self.assertEqual(done.returncode, 0, done.stderr)
            result = json.loads(path.read_text())
            VALIDATOR.validate(result)
            heights.append(result["largest"])
        self.assertEqual(heights[0], heights[1])
        summits = heights[0]["summits"]
        self.assertEqual([s["kernel"] for s in summits],
                         [ENERGY + "/analytic/f64", ENERGY + "/nearest/f64"])
        # The same number of configurations, drawn.
        fuzz, _ = self.fuzz("--kernels", ENERGY + "/analytic/f64", "--families", "deep",
                            "--families", "sliver", "--count", "20000")
        drawn = max(row["distance"]["max"] for cell in fuzz["cells"] for row in cell["rows"]
                    if row["distance"])
        self.assertGreater(summits[0]["value"], drawn)
        self.assertLess(summits[1]["value"], 1e-5)  # 50 n u over a sine of 1e-8
        done = run("fuzz", "--climb", "steepness")
        self.assertEqual(done.returncode, 2)
        self.assertIn("psd_defect", done.stderr)

    def test_every_exhibit_is_caught(self):
        done = run("fuzz", "--zoo")
        self.assertEqual(done.returncode, 0, done.stdout)
        lines = done.stdout.splitlines()[1:]
        self.assertGreaterEqual(len(lines), 7)
        for line in lines:
            self.assertNotIn("ESCAPED", line)
            self.assertLessEqual(len(line), 110)

    def test_passes_have_seeds_of_their_own(self):
        fuzz, _ = self.fuzz(*SMALL[:-2], "--count", "34", "--minutes", "0.05", "--kernels",
                            ENERGY + "/none/f64", "--families", "shift")
        seeds = {cell["seed"] for cell in fuzz["cells"]}
        self.assertEqual(seeds, set(range(42, 42 + fuzz["plan"]["passes"])))
        self.assertGreater(len(seeds), 1)
        again, _ = self.fuzz(*SMALL[:-2], "--count", "34", "--kernels", ENERGY + "/none/f64",
                             "--families", "shift", "--resume")
        self.assertEqual(again["cells"], fuzz["cells"])

    def test_bad_words(self):
        for words, wanted in (
                (("--families", "slivers"), "--families 'slivers': expected names of"),
                (("--families", "straight", "--kernels", ENERGY + "/*"), "--families: none has"),
                (("--kernels", "nothing"), "nothing"),
                (("--resume",), "--resume: expected --json FILE"),
                (("--shard", "3/2"), "--shard"),
                (("--minutes", "soon"), "--minutes"),
                (("--corpus", "/nowhere/at/all"), "--corpus"),
                (("--count", "0"), "--count")):
            done = run("fuzz", *words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(wanted, done.stderr)

    def test_the_families_are_listed(self):
        done = run("fuzz", "--list")
        self.assertEqual(done.returncode, 0)
        for family in ("edge_angle", "sliver", "unequal_strand"):
            self.assertIn(family, done.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
