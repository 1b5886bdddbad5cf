"""definite scene, from outside."""

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
NAMES = sorted(path.stem for path in (ROOT / "scenes/scenes").glob("*.hpp"))


def run(*words):
    return subprocess.run([DEFINITE, *words], capture_output=True, text=True, check=False,
                          timeout=300)


class Scene(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def scene(self, *words, code=0):
        path = self.folder / "scene.json"
        done = run("scene", "--json", str(path), *words)
        self.assertEqual(done.returncode, code, done.stderr)
        result = json.loads(path.read_text())
        VALIDATOR.validate(result)
        self.assertLessEqual(max(map(len, done.stdout.splitlines()), default=0), 100)
        return result, done

    def test_a_quick_run_has_a_verdict_for_each_scene(self):
        result, done = self.scene("all", "--quick")
        scenes = result["scenes"]["scenes"]
        self.assertEqual([s["name"] for s in scenes], NAMES)
        for scene in scenes:
            self.assertIn(scene["verdict"], ("reproduced", "partly"))  # some criterion holds
            self.assertIn(scene["name"], done.stdout)
            self.assertEqual(len({json.dumps(c["case"]) for c in scene["cases"]}),
                             len(scene["cases"]))
        # What is exact holds in every start.
        verdicts = {s["name"]: s["verdict"] for s in scenes}
        for name in ("resonance", "tilted_edge", "tilted_vertex"):
            self.assertEqual(verdicts[name], "reproduced")
        self.assertFalse(result["partial"])

    def test_threads_change_nothing(self):
        words = ("cables_unfiltered", "--starts", "3", "--ablate")
        one, three = (self.scene(*words, "--threads", n)[0]["scenes"] for n in ("1", "3"))
        self.assertEqual(one, three)
        other = self.scene(*words, "--seed", "43")[0]["scenes"]
        self.assertNotEqual(one, other)

    def test_an_ablation_takes_each_term_from_each_case(self):
        result, done = self.scene("tilted_edge", "--starts", "20", "--ablate")
        scene = result["scenes"]["scenes"][0]
        effects = {(a["change"], a["case"]["length"]): a["effect"]
                   for a in scene["ablations"]}
        self.assertEqual(effects["side_memory", "unsigned_frozen"], "changed")
        self.assertEqual(effects["load", "signed"], "changed")
        self.assertEqual(effects["springs", "signed"], "undecided")  # 20 starts are too few
        for ablation in scene["ablations"]:
            self.assertEqual(ablation["removed"], f"  -{ablation['change']} " in done.stdout)

    def test_some_of_the_criteria_make_no_verdict(self):
        result, done = self.scene("cables_popping", "--starts", "2", "--filter", "analytic")
        scene = result["scenes"]["scenes"][0]
        self.assertNotIn("verdict", scene)
        self.assertGreater(len(scene["criteria"]), 0)
        self.assertIn("no verdict", done.stdout)

    def test_a_map_covers_lengths_filters_and_mu(self):
        result, done = self.scene("tilted_edge", "--starts", "2", "--map")
        cells = result["scenes"]["scenes"][0]["map"]
        self.assertEqual(len(cells), 3 * 12 * 9)
        self.assertIn("progressive", done.stdout)
        self.assertIn("rank correlation", done.stdout)
        self.assertEqual({c["case"]["filter"] for c in cells if "error" not in c},
                         {"on_demand", "progressive"})  # which are no rows
        # Errors that are rounding rank no filter: all of an unsigned length that is not penetrated.
        popping = self.scene("cables_popping", "--starts", "4", "--map")[0]["scenes"]["scenes"][0]
        self.assertGreater(popping["prediction"]["groups"], 0)
        for cell in popping["map"]:
            for error in (cell["error"][k] for k in ("distance", "step_error") if "error" in cell):
                self.assertTrue(error == 0 or error >= 1e-9, cell)
        of_one = self.scene("tilted_edge", "--starts", "2", "--map", "--filter", "nearest")[0]
        self.assertEqual({c["case"]["filter"] for c in of_one["scenes"]["scenes"][0]["map"]},
                         {"nearest"})

    def test_what_is_recorded_can_be_read(self):
        path = self.folder / "met.csv"
        done = run("scene", "cables_popping", "--starts", "2", "--record", str(path))
        self.assertEqual(done.returncode, 0, done.stderr)
        met = len(path.read_text().splitlines()) - 3
        self.assertIn(f"{met:,} contacts", done.stdout)
        swept = run("sweep", "--kernels", "collision/edge_edge/unsigned_frozen/quadratic/analytic/f64",
                    "--distribution", str(path))
        self.assertEqual(swept.returncode, 0, swept.stderr)
        self.assertIn(f"{met:,} configurations", swept.stdout)

    def test_an_earlier_result_is_written_as_markdown(self):
        self.scene("tilted_edge", "--starts", "2", "--ablate", "--map")
        done = run("scene", "--from", str(self.folder / "scene.json"))
        self.assertEqual(done.returncode, 0, done.stderr)
        for heading in ("## Verdicts", "## Criteria of tilted_edge", "## Ablation of tilted_edge",
                        "## Map of tilted_edge"):
            self.assertIn(heading, done.stdout)

    def test_an_interrupt_keeps_complete_scenes(self):
        path = self.folder / "partial.json"
        with subprocess.Popen([DEFINITE, "scene", "all", "--starts", "2000", "--json", str(path)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
            time.sleep(1)
            child.send_signal(signal.SIGINT)
            error = child.communicate(timeout=60)[1]
        self.assertEqual(child.returncode, 130)
        self.assertIn("interrupted", error)
        result = json.loads(path.read_text())
        VALIDATOR.validate(result)
        self.assertTrue(result["partial"])

    def test_bad_input_is_explained(self):
        for words, message in (
                (("cable",), "NAME 'cable': expected all or one of"),
                (("all", "--starts", "0"), "--starts '0': expected at least 1"),
                (("all", "--filter", "analytical"), "--filter 'analytical': expected a filter"),
                (("all", "--record", str(self.folder / "x.csv")), "--record: expected one scene"),
                (("all", "--quick", "--starts", "3"), "--quick"),
                (("--from", "none.json"), "--from 'none.json': cannot read it")):
            done = run("scene", *words)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn(message, done.stderr)

    def test_the_scenes_are_listed(self):
        done = run("scene", "--list")
        for name in NAMES:
            self.assertIn(name, done.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
