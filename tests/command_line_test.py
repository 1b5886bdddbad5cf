"""The command line of definite: python3 command_line_test.py DEFINITE BROKEN_DEFINITE [unittest's]

BROKEN_DEFINITE is the same program with a filter that breaks its promises.
"""

import copy
import fnmatch
import json
import math
import os
import pathlib
import pty
import re
import resource
import select
import shlex
import signal
import stat
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import jsonschema

PROGRAM, BROKEN_PROGRAM = sys.argv[1:3]
SCHEMA = json.loads(
    (pathlib.Path(__file__).resolve().parent.parent / "results/schema.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
TIMEOUT = 120  # seconds; a sanitizer may be slow
ERASE = "\r\x1b[K"
ENERGY = "collision/vertex_face/signed/quadratic"
ROWS = [word for name in ("analytic", "gauss_newton", "none", "numeric")
        for word in ("--kernels", f"{ENERGY}/{name}/*")]
FAST = ["--kernels", ENERGY + "/gauss_newton/f64", "--distribution", "paper", "--no-timing"]


def run(*words, program=PROGRAM, **options):
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True,
               "timeout": TIMEOUT, **options}
    return subprocess.run([program, *words], check=False, **options)


def sweep(*words):
    """The JSON of a sweep that ends well."""
    done = run("sweep", "--json", "-", *words)
    if done.returncode != 0:
        raise AssertionError(f"exit {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def row_names(*words):
    return run("list", *words).stdout.split()


def checksums(result):
    return {row["kernel"]: row["checksum"] for row in result["rows"]}


def long_lines(text):
    return [line for line in text.splitlines() if len(line) > 100]


class OnTerminal:
    """A program that runs with a terminal as its standard error, until the test ends."""

    def __init__(self, test, *words, stdout=subprocess.PIPE):
        self.master, terminal = pty.openpty()
        self.process = subprocess.Popen([PROGRAM, *words], text=True, stderr=terminal,
                                        stdout=terminal if stdout is None else stdout)
        os.close(terminal)
        test.addCleanup(self.process.kill)
        self.shown = ""

    def read_until(self, pattern):
        deadline = time.monotonic() + TIMEOUT
        while not re.search(pattern, self.shown):
            if not self.read() or time.monotonic() > deadline:
                raise AssertionError(f"no {pattern!r} in {self.shown[-1000:]!r}")

    def read(self):
        """Nothing at the end, or after a long silence."""
        part = ""
        if select.select([self.master], [], [], TIMEOUT)[0]:
            try:
                part = os.read(self.master, 65536).decode()
            except OSError:  # the other side is closed
                pass
        self.shown += part
        return part

    def finish(self):
        """What standard output got."""
        reader = threading.Thread(target=self.read_all, daemon=True)
        reader.start()
        output, _ = self.process.communicate(timeout=TIMEOUT)
        reader.join()
        os.close(self.master)
        return output

    def read_all(self):
        while self.read():
            pass


class Help(unittest.TestCase):
    def test_each_command_has_help_with_examples_within_100_columns(self):
        for command in ([], ["sweep"], ["replay"], ["list"], ["verify"], ["merge"], ["compare"],
                        ["export"], ["doctor"], ["speed"], ["report"], ["advise"], ["fuzz"],
                        ["scene"], ["newton"]):
            with self.subTest(command=command):
                done = run(*command, "--help")
                self.assertEqual(done.returncode, 0)
                self.assertIn("Example", done.stdout)
                self.assertEqual(long_lines(done.stdout), [])
                self.assertEqual(done.stderr, "")

    def test_it_names_the_subcommands_and_the_exit_codes(self):
        text = run("--help").stdout
        for word in ("sweep", "replay", "list", "0 all is well", "1 a promise is broken",
                     "2 bad input", "130 interrupted"):
            self.assertIn(word, text)

    def test_it_shows_the_defaults(self):
        text = run("sweep", "--help").stdout
        for option, default in (("--kernels", "all"), ("--distribution", "active"),
                                ("--count", "1e7"), ("--seed", "42"), ("--threads", "all cores")):
            self.assertRegex(text, rf"{option} [^(]*\(default: {default}")

    def test_the_version_tells_the_build(self):
        self.assertIn("commit", json.loads(run("--version").stdout))


class Listing(unittest.TestCase):
    def test_it_prints_each_name_once(self):
        names = row_names()
        self.assertIn(ENERGY + "/analytic/f64", names)
        self.assertEqual(len(names), len(set(names)))

    def test_a_star_crosses_slashes(self):
        for glob in ("collision/*/analytic/*", "*f64", "*/numeric/f64", "*/none/f64?*"):
            with self.subTest(glob=glob):
                expected = [name for name in row_names() if fnmatch.fnmatchcase(name, glob)]
                self.assertNotEqual(expected, [])
                self.assertEqual(row_names("--kernels", glob), expected)

    def test_globs_add_up(self):
        both = row_names("--kernels", "*/numeric/*", "--kernels", "*/none/*")
        self.assertEqual(set(both), set(row_names("--kernels", "*/numeric/*") +
                                        row_names("--kernels", "*/none/*")))

    def test_sources_parameters_and_promises_fit_100_columns(self):
        for form, word in (("--long", "stiffness"), ("--promises", "finite")):
            text = run("list", form).stdout
            self.assertIn(word, text)
            self.assertEqual(long_lines(text), [])


class BadInput(unittest.TestCase):
    def assert_rejected(self, words, *said, **options):
        """Exit 2, nothing on standard output, and an error that says all of this; returns it."""
        done = run(*words, **options)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertTrue(done.stderr.startswith("definite: "), done.stderr)
        for words_said in said:
            self.assertIn(words_said, done.stderr)
        return done.stderr

    def test_a_count_that_is_no_whole_number_is_rejected(self):
        for count in ("1.5", "abc", "1e400", "", " 5", "1e3x", "nan", "0x10", "1e-3"):
            with self.subTest(count=count):
                self.assert_rejected(["sweep", "--count", count], f"--count '{count}'",
                                     "expected a whole number such as")

    def test_a_count_below_one_is_rejected(self):
        for count in ("-5", "0", "-1e7", "-inf"):
            with self.subTest(count=count):
                self.assert_rejected(["sweep", "--count", count], f"--count '{count}'",
                                     "expected at least 1")

    def test_a_count_beyond_exact_doubles_is_rejected(self):
        for count in ("1e16", "inf", "1e300G"):
            with self.subTest(count=count):
                self.assert_rejected(["sweep", "--count", count], f"--count '{count}'",
                                     "expected at most 9007199254740992")

    def test_quick_with_a_count_is_rejected(self):
        self.assert_rejected(["sweep", "--quick", "--count", "5"], "--count", "--quick")

    def test_a_set_that_is_no_name_and_number_is_rejected(self):
        replay = ["replay", "--kernel", row_names()[0], "--index", "0"]
        for command in (["sweep"], replay, ["reproduce", "collision-accuracy"]):
            for word, said in (("side", "expected NAME=VALUE"), ("side=", "expected a number"),
                               ("side=x", "expected a number"), ("side=1x", "expected a number"),
                               ("side=nan", "expected a number"), ("eps=inf", "expected a number"),
                               ("eps=1e999", "expected a number"), ("", "expected NAME=VALUE"),
                               ("siede=1", "parameter 'siede'"), ("=1", "parameter ''")):
                with self.subTest(command=command[0], word=word):
                    self.assert_rejected([*command, "--set", word], f"--set '{word}': ", said)

    def test_a_parameter_that_no_energy_asked_for_has_is_rejected_with_those_there_are(self):
        for command in (["sweep", "--kernels", ENERGY + "/*"],
                        ["replay", "--kernel", ENERGY + "/none/f64", "--index", "0"]):
            self.assert_rejected([*command, "--set", "m=0.6"], "--set 'm=0.6'", "'m'",
                                 "there are: k, eps, side")

    def test_a_parameter_set_twice_is_rejected(self):
        self.assert_rejected(["sweep", "--set", "k=2", "--set", "k=3"], "--set 'k=3'",
                             "k is set already")

    def test_threads_below_one_are_rejected(self):
        for threads in ("0", "-1"):
            with self.subTest(threads=threads):
                self.assert_rejected(["sweep", "--threads", threads], f"--threads '{threads}'",
                                     "expected at least 1")

    def test_a_seed_below_zero_is_rejected(self):
        self.assert_rejected(["sweep", "--seed", "-1"], "--seed '-1'", "expected at least 0")

    def test_an_unknown_distribution_is_rejected_with_the_known_ones(self):
        for command in (["sweep"], ["replay", "--kernel", row_names()[0], "--index", "0"]):
            self.assert_rejected([*command, "--distribution", "papre"], "--distribution 'papre'",
                                 "expected one of", "active", "normal", "paper")

    def test_a_glob_that_matches_nothing_is_rejected_with_near_names(self):
        numeric = [name for name in row_names() if name.endswith("/numeric/f64")]
        collision = [name for name in numeric if name.startswith("collision/")]
        for glob, near in (("*/numerc/f64", numeric), ("colision/*/numeric/f64", collision),
                           ("numeric", numeric)):
            for command in ("sweep", "list"):
                with self.subTest(glob=glob, command=command):
                    text = self.assert_rejected([command, "--kernels", glob],
                                                f"--kernels '{glob}'", "nearest are:\n  ")
                    self.assertIn(text.split("nearest are:\n  ")[1].split("\n")[0], near)

    def test_an_unknown_row_is_rejected_with_near_names(self):
        name = ENERGY + "/numeric/f64"
        self.assert_rejected(["replay", "--kernel", name[:-1], "--index", "0"],
                             f"--kernel '{name[:-1]}'", f"nearest are:\n  {name}\n")

    def test_an_unknown_subcommand_is_rejected_with_the_known_ones(self):
        self.assert_rejected(["swep"], "'swep'",
                             "expected a subcommand: sweep, speed, replay, list, reproduce, verify")

    def test_no_subcommand_is_rejected_with_the_known_ones(self):
        self.assert_rejected([], "expected a subcommand: sweep, speed, replay, list, reproduce, verify")

    def test_an_unknown_option_is_rejected(self):
        for command in ("sweep", "list", "replay"):
            self.assert_rejected([command, "--bogus"], "'--bogus'", command,
                                 f"definite {command} --help")

    def test_a_word_too_many_is_rejected(self):
        self.assert_rejected(["sweep", "extra"], "'extra'", "sweep")

    def test_an_option_without_its_value_is_rejected(self):
        self.assert_rejected(["sweep", "--count"], "--count")

    def test_a_replay_without_row_or_index_is_rejected(self):
        self.assert_rejected(["replay", "--index", "5"], "--kernel")
        self.assert_rejected(["replay", "--kernel", row_names()[0]], "--index")

    def test_an_index_that_is_no_whole_number_is_rejected(self):
        for index in ("-1", "abc"):
            self.assert_rejected(["replay", "--kernel", row_names()[0], "--index", index],
                                 f"--index '{index}'", "expected")

    def test_an_error_that_nobody_can_read_keeps_its_exit_code(self):
        with open("/dev/full", "w") as full:
            self.assertEqual(run("sweep", "--count", "-5", stderr=full).returncode, 2)


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "result.json"

    def sweep_to(self, path, count="1000", **options):
        return run("sweep", "--count", count, *FAST, "--json", path, **options)

    def assert_error(self, done, path, reason):
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(f"definite: --json '{path}': ", done.stderr)
        self.assertIn(reason, done.stderr)

    def test_a_file_gets_the_result_and_standard_output_the_table(self):
        done = self.sweep_to(self.file)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("gauss_newton", done.stdout)
        VALIDATOR.validate(json.loads(self.file.read_text()))
        self.assertEqual(list(self.folder.iterdir()), [self.file])

    def test_an_existing_file_is_replaced(self):
        self.file.write_text("old")
        self.assertEqual(self.sweep_to(self.file).returncode, 0)
        VALIDATOR.validate(json.loads(self.file.read_text()))

    def test_a_link_stays_a_link(self):
        link = self.folder / "link"
        link.symlink_to(self.file)
        self.file.write_text("old")
        self.assertEqual(self.sweep_to(link).returncode, 0)
        self.assertTrue(link.is_symlink())
        VALIDATOR.validate(json.loads(self.file.read_text()))

    def test_a_path_that_is_not_utf8_is_written(self):
        path = os.fsencode(self.folder) + b"/\xff"
        self.assertEqual(self.sweep_to(path).returncode, 0)
        with open(path, encoding="utf-8") as file:
            VALIDATOR.validate(json.load(file))

    def test_a_path_that_cannot_be_written_fails_before_the_sweep(self):
        self.file.write_text("old")
        for path, reason in ((self.file / "x", "Not a directory"),
                             (self.folder / "missing/x", "No such file or directory"),
                             (self.folder, "Is a directory"),
                             (self.folder / ("x" * 300), "File name too long"),
                             ("", "expected the name of a file")):
            with self.subTest(path=path):
                done = self.sweep_to(path, count="1e9")
                self.assert_error(done, path, reason)
                self.assertEqual(done.stdout, "")
        self.assertEqual(os.listdir(self.folder), ["result.json"])
        self.assertEqual(self.file.read_text(), "old")

    def run_with_full_disk(self):
        # Less than the result has, more than the kilobyte that clang's OpenMP shares between threads.
        # Without a folder for it the thread sanitizer makes no file of its own, which would fail too.
        done = self.sweep_to(self.file, env={**os.environ, "TMPDIR": str(self.folder / "none")},
                             preexec_fn=lambda: resource.setrlimit(
                                 resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assert_error(done, self.file, "cannot write it: File too large")
        self.assertIn("gauss_newton", done.stdout)  # the table is not lost with the file

    def test_a_full_disk_leaves_no_file(self):
        self.run_with_full_disk()
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_full_disk_leaves_an_existing_file_as_it_was(self):
        self.file.write_text("old")
        self.run_with_full_disk()
        self.assertEqual(os.listdir(self.folder), ["result.json"])
        self.assertEqual(self.file.read_text(), "old")

    def device(self, name, minor):
        """One of our own where we may, since root's program could replace that of the system."""
        try:
            os.mknod(self.file, 0o666 | stat.S_IFCHR, os.makedev(1, minor))
        except PermissionError:
            return f"/dev/{name}"
        return self.file

    def test_a_device_is_written_directly(self):
        device = self.device("null", 3)
        self.assertEqual(self.sweep_to(device).returncode, 0)
        self.assertTrue(stat.S_ISCHR(os.stat(device).st_mode))

    def test_a_full_device_is_an_error(self):
        device = self.device("full", 7)
        self.assert_error(self.sweep_to(device), device,
                          "cannot write it: No space left on device")
        self.assertTrue(stat.S_ISCHR(os.stat(device).st_mode))

    def test_a_full_standard_output_is_an_error(self):
        for words in (["list"], ["--help"], ["sweep", "--count", "1000", *FAST],
                      ["sweep", "--count", "1000", *FAST, "--json", "-"],
                      ["replay", "--kernel", row_names()[0], "--index", "0"]):
            with self.subTest(words=words), open("/dev/full", "w") as full:
                done = run(*words, stdout=full)
                self.assertEqual(done.returncode, 2)
                self.assertIn("No space left on device", done.stderr)

    def test_a_pipe_is_written_directly(self):
        os.mkfifo(self.file)
        read = []
        reader = threading.Thread(target=lambda: read.append(self.file.read_text()), daemon=True)
        reader.start()
        self.assertEqual(self.sweep_to(self.file).returncode, 0)
        reader.join(TIMEOUT)
        VALIDATOR.validate(json.loads(read[0]))
        self.assertTrue(stat.S_ISFIFO(os.stat(self.file).st_mode))
        self.assertEqual(os.listdir(self.folder), ["result.json"])

    def test_a_killed_sweep_leaves_no_file(self):
        running = OnTerminal(self, "sweep", "--count", "1e9", *FAST, "--json", self.file)
        running.read_until("checked pass")
        self.assertEqual(os.listdir(self.folder), [])
        running.process.kill()
        running.finish()
        self.assertEqual(os.listdir(self.folder), [])


class Interruption(unittest.TestCase):
    def interrupt(self, stage, *words):
        running = OnTerminal(self, "sweep", "--count", "1e9", *words)
        running.read_until(stage)
        running.process.send_signal(signal.SIGINT)
        output = running.finish()
        self.assertEqual(running.process.returncode, 130, running.shown)
        self.assertIn("definite: interrupted", running.shown)
        return output

    def test_what_is_checked_by_then_is_a_prefix(self):
        result = json.loads(self.interrupt("checked pass", *FAST, "--json", "-"))
        VALIDATOR.validate(result)
        self.assertIs(result["partial"], True)
        row = result["rows"][0]
        self.assertGreater(row["count"], 0)
        self.assertLess(row["count"], 1e9)
        whole = sweep("--count", str(row["count"]), *FAST)
        self.assertIs(whole["partial"], False)
        for key in ("count", "active", "checksum"):
            self.assertEqual(row[key], whole["rows"][0][key])

    def test_what_is_timed_by_then_is_written(self):
        result = json.loads(self.interrupt("timed pass", *ROWS, "--json", "-"))
        VALIDATOR.validate(result)
        self.assertIs(result["partial"], True)
        self.assertEqual({row["count"] for row in result["rows"]}, {0})

    def test_a_file_is_written_whole(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "result.json"
            self.interrupt("checked pass", *FAST, "--json", path)
            self.assertEqual(os.listdir(folder), ["result.json"])
            result = json.loads(path.read_text())
        VALIDATOR.validate(result)
        self.assertIs(result["partial"], True)

    def test_the_table_shows_what_is_complete(self):
        self.assertIn("gauss_newton", self.interrupt("checked pass", *FAST))


class Screen(unittest.TestCase):
    def test_progress_is_drawn_with_the_time_left_and_erased(self):
        running = OnTerminal(self, "sweep", "--count", "20k", *FAST[:4], "--json", "-")
        json.loads(running.finish())
        draws = running.shown.split(ERASE)
        self.assertTrue(any(re.match(r"timed pass +\[=* *\] +\d+ %", draw) for draw in draws))
        self.assertTrue(any(re.match(r"checked pass +\[=* *\] +\d+ %.* left", draw)
                            for draw in draws), running.shown)
        self.assertTrue(running.shown.endswith(ERASE))
        self.assertLessEqual(max(map(len, draws)), 100)

    def test_progress_is_absent_on_a_pipe(self):
        done = run("sweep", "--count", "10k", *FAST[:4])
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_standard_output_is_nothing_but_json_where_it_is_asked_for(self):
        done = run("sweep", "--count", "1000", *FAST, "--json", "-")
        self.assertEqual(done.stderr, "")
        json.loads(done.stdout)
        self.assertEqual(done.stdout.count("\n"), 1)

    def test_the_table_has_every_row_within_100_columns(self):
        for words in ([], ["--no-timing"], ["--distribution", "normal"]):
            with self.subTest(words=words):
                rows = ["--kernels", ENERGY + "/*"]
                text = run("sweep", "--count", "500", *rows, *words).stdout
                self.assertEqual(long_lines(text), [])
                self.assertIn(ENERGY, text.splitlines())
                for name in row_names(*rows):
                    kernel, scalar = name.split("/")[-2:]
                    self.assertRegex(text, rf"(?m)^{kernel} +{scalar} ")

    def test_all_of_a_terminal_fits_100_columns(self):
        running = OnTerminal(self, "sweep", "--count", "1000", *ROWS, stdout=None)
        running.finish()
        self.assertEqual(running.process.returncode, 0)
        self.assertEqual(long_lines(running.shown.replace(ERASE, "\n")), [])


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = sweep("--count", "2000", *ROWS)

    def test_it_is_a_schema(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)

    def test_a_sweep_fits_it(self):
        VALIDATOR.validate(self.result)
        self.assertEqual(VALIDATOR.schema["$schema"],
                         "https://json-schema.org/draft/2020-12/schema")

    def objects(self, value, path=()):
        """The path of every object, in lists those of the first element only."""
        if isinstance(value, dict):
            yield path
            for key, part in value.items():
                yield from self.objects(part, (*path, key))
        elif isinstance(value, list) and value:
            yield from self.objects(value[0], (*path, 0))

    def at(self, path, value):
        for key in path:
            value = value[key]
        return value

    def spoilt(self, path, spoil):
        result = copy.deepcopy({**self.result, "rows": self.result["rows"][:1]})
        spoil(self.at(path, result))
        return result

    def test_a_missing_key_does_not_fit_it(self):
        self.assert_none_fits(lambda spoilt, key: spoilt.pop(key))

    def test_a_wrong_type_does_not_fit_it(self):
        self.assert_none_fits(lambda spoilt, key: spoilt.update({key: {"a": 1}}),
                              but=[("plan", "set")])  # a map of such

    def test_an_extra_key_does_not_fit_it(self):
        self.assert_none_fits(lambda spoilt, key: spoilt.update({key + "_": spoilt[key]}),
                              but=[("blocks", ENERGY)])  # a map of energies

    def assert_none_fits(self, spoil, but=()):
        """Spoils each key of each object in turn, in lists those of the first element only."""
        fit = []
        for path in self.objects(self.result):
            for key in self.at(path, self.result):
                result = self.spoilt(path, lambda part: spoil(part, key))
                if VALIDATOR.is_valid(result):
                    fit.append((*path, key))
        self.assertEqual(fit, list(but))


class Sweeps(unittest.TestCase):
    def test_the_defaults_are_every_row_active_seed_42_and_all_cores(self):
        result = sweep("--count", "200")
        self.assertEqual([row["kernel"] for row in result["rows"]], row_names())
        self.assertEqual({row["distribution"] for row in result["rows"]}, {"active"})
        self.assertEqual(result["seed"], 42)
        self.assertEqual({timing["threads"] for row in result["rows"] for timing in row["timing"]},
                         {len(os.sched_getaffinity(0))})

    def test_a_glob_selects_exactly_its_rows(self):
        glob = "collision/*/analytic/*"
        result = sweep("--count", "200", "--kernels", glob)
        self.assertEqual([row["kernel"] for row in result["rows"]],
                         [name for name in row_names() if fnmatch.fnmatchcase(name, glob)])

    def test_quick_is_a_hundred_thousand(self):
        self.assertEqual(sweep("--quick", *FAST)["rows"][0]["count"], 100_000)

    def test_a_count_may_be_written_in_three_ways(self):
        rows = [sweep("--count", count, *FAST)["rows"] for count in ("1000", "1e3", "1k")]
        self.assertEqual(rows[0][0]["count"], 1000)
        self.assertEqual(rows[1], rows[0])
        self.assertEqual(rows[2], rows[0])

    def test_without_timing_nothing_is_timed(self):
        for words, timings in ((["--no-timing"], []), ([], ["all", "active"])):
            for row in sweep("--count", "1000", *ROWS, *words)["rows"]:
                self.assertEqual([timing["pairs"] for timing in row["timing"]], timings)

    def test_the_result_tells_its_command(self):
        words = ["sweep", "--json", "-", "--count", "1000", *FAST]
        self.assertEqual(json.loads(run(*words).stdout)["command"], [PROGRAM, *words])

    def test_results_do_not_depend_on_the_number_of_threads(self):
        def statistics(threads):
            result = sweep("--count", "5000", "--threads", threads, *ROWS)
            for key in ("machine", "command"):
                del result[key]
            for row in result["rows"]:
                self.assertEqual([timing["threads"] for timing in row.pop("timing")],
                                 [int(threads)] * 2)
            return json.dumps(result)

        one = statistics("1")
        self.assertEqual(statistics("2"), one)
        self.assertEqual(statistics("7"), one)

    def test_a_seed_fixes_the_outputs(self):
        first, again, other = (
            checksums(sweep("--count", "1000", "--no-timing", *ROWS, "--seed", seed))
            for seed in ("7", "7", "8"))
        self.assertEqual(first, again)
        for name, checksum in first.items():
            self.assertNotEqual(checksum, other[name])

    def test_a_distribution_changes_the_outputs(self):
        found = [checksums(sweep("--count", "1000", "--no-timing", *ROWS, "--distribution", name))
                 for name in ("active", "normal", "paper")]
        for name in found[0]:
            self.assertEqual(len({sums[name] for sums in found}), 3)

    def test_lanes_equal_scalars(self):
        found = checksums(sweep("--count", "2000", "--no-timing", *ROWS))
        lanes = [name for name in found if name.endswith("/f64x8")]
        self.assertNotEqual(lanes, [])
        for name in lanes:
            self.assertEqual(found[name], found[name.removesuffix("x8")])


class Speed(unittest.TestCase):
    WORDS = ("speed", "--kernels", ENERGY + "/analytic/f64x8*", "--kernels", ENERGY + "/numeric/f64",
             "--kernels", ENERGY + "/gauss_newton/f64", "--ring", "L1", "--rounds", "3",
             "--job", "20000", "--elements", "3000")

    def test_its_json_has_each_row_with_its_ratios_and_floor(self):
        done = run(*self.WORDS, "--threads", "1", "--threads", "2", "--json", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout)
        VALIDATOR.validate(result)
        rows = result["speed"]["rows"]
        listed = [name for name in row_names("--outputs", "--kernels", ENERGY + "/*")
                  if name.startswith(ENERGY + "/analytic/f64x8")]
        self.assertGreater(len(listed), 3)
        for threads in (1, 2):
            timed = [row for row in rows if row["threads"] == threads]
            self.assertEqual({row["kernel"] for row in timed},
                             {*listed, ENERGY + "/numeric/f64", ENERGY + "/gauss_newton/f64"})
            for row in timed:
                self.assertEqual(row["rounds"], 3)
                self.assertEqual(row["floor"] is None, row["kernel"].endswith("/f64"), row)
                self.assertIsNotNone(row["ratio_to"]["numeric"])
                if row["kernel"].endswith("/numeric/f64"):
                    self.assertEqual(row["ratio_to"]["numeric"]["median"], 1)
        for row in rows:
            if row["floor"]:
                floor = row["floor"]
                self.assertEqual(floor["ns"], max(floor[part + "_ns"] for part in (
                    "arithmetic", "division", "stores")))
                self.assertEqual(floor["ns"], floor[floor["binds"] + "_ns"])

        jobs = result["speed"]["jobs"]
        self.assertEqual([(job["kernel"], job["threads"], job["count"]) for job in jobs],
                         [(ENERGY + "/analytic/f64x8", threads, 20000) for threads in (1, 2)])
        for job in jobs:
            seconds = job["seconds"]
            self.assertEqual(seconds["total"], seconds["draw"] + seconds["packed"])
        assemblies = result["speed"]["assemblies"]
        self.assertEqual([(one["kernel"], one["threads"], one["elements"], one["rounds"])
                          for one in assemblies],
                         [(ENERGY + "/analytic/f64x8", threads, 3000, 3) for threads in (1, 2)])
        # Each of the 1500 vertices has a block, and each element at most six others.
        self.assertTrue(1500 < assemblies[0]["blocks"] <= 1500 + 6 * 3000)

    def test_the_tables_of_a_file_need_its_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            file, page = pathlib.Path(folder) / "speed.json", pathlib.Path(folder) / "speed.md"
            done = run(*self.WORDS, "--threads", "1", "--json", file)
            self.assertEqual(done.returncode, 0, done.stderr)
            done = run("speed", "--from", file, "--markdown", page)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, f"--from '{file}': the result lacks {ENERGY}/"
                                          "(analytic|gauss_newton)_frame/f64, outputs in L1, 1 thread")
            self.assertFalse(page.exists())

            # As if all rows were there.
            result = json.loads(file.read_text())
            row = result["speed"]["rows"][0]
            for energy in (ENERGY, "collision/edge_edge/signed/quadratic"):
                for name in ("analytic_frame/f64", "gauss_newton_frame/f64", "gauss_newton/f64",
                             "analytic/f64", "analytic/f64x8", "gauss_newton/f64x8"):
                    for ring in ("L1", "L2", "memory"):
                        for threads in (1, 2):
                            ns = dict.fromkeys(("median", "minimum", "low", "high"), len(name))
                            result["speed"]["rows"].insert(0, {
                                **row, "kernel": f"{energy}/{name}", "ring": ring,
                                "threads": threads, "ns_per_hessian": ns})
            file.write_text(json.dumps(result))
            VALIDATOR.validate(result)
            done = run("speed", "--from", file)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual([line for line in done.stdout.splitlines() if len(line) > 98], [])
            # 18 and 22 letters.
            self.assertRegex(done.stdout, r"\| both through the frame +\| vertex-face +\| +18\.0 \| "
                                          r"+22\.0 \|  0\.82 \|")
            self.assertRegex(done.stdout, r"\| the same, 2 threads +\| +edge-edge \| +28\.0 \|")
            self.assertEqual(run("speed", "--from", file, "--markdown", page).stdout, "")
            self.assertEqual(page.read_text(), done.stdout)

            (pathlib.Path(folder) / "other.json").write_text('{"schema": 5}')
            done = run("speed", "--from", pathlib.Path(folder) / "other.json")
            self.assertEqual(done.returncode, 2)
            self.assertIn("expected a result of definite, schema definite/1", done.stderr)

    def test_jobs_and_assemblies_can_be_left_out(self):
        done = run("speed", "--kernels", ENERGY + "/analytic/f64x8*", "--ring", "L1", "--threads", "1",
                   "--rounds", "1", "--job", "0", "--elements", "0", "--json", "-")
        speed = json.loads(done.stdout)["speed"]
        self.assertEqual((speed["jobs"], speed["assemblies"]), ([], []))

    def test_its_table_fits_100_columns(self):
        done = run(*self.WORDS, "--threads", "1")
        self.assertIn("analytic/f64x8/applied", done.stdout)
        self.assertIn("The whole job: 2e+04 configurations of active", done.stdout)
        self.assertIn("Scatter-add: 3e+03 elements", done.stdout)
        self.assertEqual([line for line in done.stdout.splitlines()
                          if len(line) > 100 or line != line.rstrip()], [])

    def test_bad_words_are_rejected_by_name(self):
        for words, said in ((("--ring", "L3"), "--ring 'L3': expected L1, L2 or memory"),
                            (("--threads", "0"), "--threads '0'"), (("--rounds", "x"), "--rounds 'x'"),
                            (("--job", "-1"), "--job '-1'"), (("--elements", "x"), "--elements 'x'")):
            done = run("speed", *words)
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stderr)


class Set(unittest.TestCase):
    """Parameters set for a whole sweep."""

    ROWS = [word for name in ("analytic", "none") for word in
            ("--kernels", f"collision/vertex_face/unsigned/quadratic/{name}/f64")]

    def parameters(self, *words):
        """The row without words, the row with them, and the parameters at the worst case."""
        drawn = sweep("--count", "1000", "--no-timing", *self.ROWS)["rows"][0]
        result = sweep("--count", "1000", "--no-timing", *self.ROWS, *words)
        VALIDATOR.validate(result)
        row = result["rows"][0]
        return drawn, row, [float.fromhex(p) for p in row["accuracy"]["distance"]["max"]["p"]]

    def test_what_is_set_holds_for_every_configuration_and_is_recorded(self):
        for words, set_, p in ((["--set", "side=-1"], {"side": -1}, [1, 0.1, -1]),
                               (["--set", "k=2.5", "--set", "eps=1e-1"], {"k": 2.5, "eps": 0.1},
                                [2.5, 0.1, 0])):
            drawn, row, found = self.parameters(*words)
            self.assertNotIn("set", drawn)
            self.assertEqual(row["set"], set_)
            self.assertEqual(found, p)
            self.assertNotEqual(row["checksum"], drawn["checksum"])

    def test_it_changes_what_is_active(self):
        active = {side: sweep("--count", "1000", "--no-timing", "--distribution", "normal",
                              *self.ROWS, "--set", f"side={side}")["rows"][0]["active"]
                  for side in (1, -1)}
        self.assertLess(active[1], 900)
        self.assertEqual(active[-1], 1000)

    def test_energies_without_the_parameter_are_as_they_were(self):
        rows = ["--kernels", "collision/vertex_face/signed/quadratic/none/f64",
                "--kernels", "collision/vertex_face/signed/cubic/none/f64"]
        drawn, changed = (checksums(sweep("--count", "500", "--no-timing", *rows, *words))
                          for words in ([], ["--set", "delta=1"]))
        self.assertEqual([drawn[name] == changed[name] for name in drawn], [True, False])
        result = sweep("--count", "500", "--no-timing", *rows, "--set", "delta=1")
        self.assertEqual([row.get("set") for row in result["rows"]], [None, {"delta": 1}])

    def test_the_timed_pass_has_it_too(self):
        rows = sweep("--count", "2000", "--kernels", self.ROWS[1], "--distribution", "normal",
                     "--set", "side=1", "--set", "eps=1e-9")["rows"]
        self.assertEqual([timing["pairs"] for timing in rows[0]["timing"]], ["all"])

    def test_a_worst_case_replays_with_it(self):
        words = ["--distribution", "normal", "--seed", "3", "--set", "side=-1", "--set", "eps=0.5"]
        result = sweep("--count", "2000", "--no-timing", *self.ROWS, *words)
        worst = result["rows"][0]["accuracy"]["distance"]["max"]
        replay = json.loads(run("replay", "--json", "--kernel", result["rows"][0]["kernel"],
                                "--index", str(worst["index"]), *words).stdout)
        self.assertEqual((replay["x"], replay["p"]), (worst["x"], worst["p"]))
        shown = next(r for r in replay["rows"] if r["kernel"] == result["rows"][0]["kernel"])
        self.assertEqual(shown["distance"], worst["exact"])

    def test_people_see_it(self):
        table = run("sweep", "--count", "500", *self.ROWS, "--set", "side=-1").stdout
        self.assertIn("active, side = -1, seed 42", table)
        replay = run("replay", "--kernel", self.ROWS[1], "--index", "3", "--set", "side=-1").stdout
        self.assertIn("active, side = -1, seed 42, index 3\n", replay)


class Replays(unittest.TestCase):
    NAME = ENERGY + "/analytic/f64"

    def replay(self, index, *words):
        done = run("replay", "--kernel", self.NAME, "--index", str(index), "--json", *words)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def test_the_worst_cases_of_a_sweep_show_the_same_figures(self):
        drawn = ["--seed", "9", "--distribution", "normal"]
        result = sweep("--count", "3000", "--no-timing", *ROWS, *drawn)
        replays = {}
        for row in result["rows"]:
            for name in ("distance", "excess", "rounding", "conditioned_rounding", "psd_defect",
                         "majorises", "relabelling"):
                worst = row["accuracy"][name]["max"]
                index = worst["index"]
                if index not in replays:
                    replays[index] = self.replay(index, *drawn)
                replay = replays[index]
                for key in ("x", "p"):
                    self.assertEqual([float.fromhex(number) for number in worst[key]],
                                     [float.fromhex(number) for number in replay[key]])
                figures = next(r for r in replay["rows"] if r["kernel"] == row["kernel"])
                value = worst["value"] if worst["exact"] is None else worst["exact"]
                self.assertEqual(figures[name], value, (row["kernel"], name, index))

    def test_it_has_every_row_of_the_energy(self):
        replay = self.replay(5)
        self.assertEqual([row["kernel"] for row in replay["rows"]],
                         row_names("--kernels", ENERGY + "/*"))
        verdicts = {row["kernel"]: row["verdict"] for row in replay["rows"]}
        self.assertEqual(verdicts[self.NAME], "pass")
        self.assertEqual(verdicts[ENERGY + "/none/f64"], "non_psd")

    def test_the_eigenvalues_are_those_of_the_hessian(self):
        replay = self.replay(5)
        eigenvalues = [float.fromhex(value) for value in replay["eigenvalues"]]
        self.assertEqual(eigenvalues, sorted(eigenvalues))
        packed = next(row["matrix"] for row in replay["rows"] if row["kernel"].endswith("none/f64"))
        entries = iter(map(float.fromhex, packed))
        trace = squares = 0
        for i in range(12):
            for j in range(i, 12):
                entry = next(entries)
                trace += entry if i == j else 0
                squares += entry**2 * (1 if i == j else 2)
        self.assertTrue(math.isclose(sum(eigenvalues), trace, rel_tol=1e-12))
        self.assertTrue(math.isclose(sum(v**2 for v in eigenvalues), squares, rel_tol=1e-12))

    def test_people_see_decimal_and_hex_floats_eigenvalues_and_verdicts(self):
        done = run("replay", "--kernel", self.NAME, "--index", "5")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(long_lines(done.stdout), [])
        replay = self.replay(5)
        shown = re.findall(r"(?m)^x\d\[\d\] +(\S+)  (\S+)$", done.stdout)
        self.assertEqual([number for _, number in shown], replay["x"])
        for decimal, number in shown:
            self.assertEqual(float(decimal), float.fromhex(number))
        for value in replay["eigenvalues"]:
            self.assertIn(f"\n  {float.fromhex(value):.17g}\n", done.stdout)
        for row in replay["rows"]:
            kernel = "/".join(row["kernel"].rsplit("/", 2)[1:])
            self.assertRegex(done.stdout, rf"(?m)^{kernel} .* {row['verdict']}$")
            if kernel.endswith("/f64"):
                self.assertIn(f"\n{row['kernel']}, in units of 1e", done.stdout)

    def test_the_entries_of_a_matrix_stand_apart(self):
        text = run("replay", "--kernel", self.NAME, "--index", "44").stdout
        matrix = text.split(f"\n{self.NAME}, in units of ")[1].split("\n")[1:13]
        self.assertEqual([len(line.split()) for line in matrix], list(range(12, 0, -1)))


class BrokenPromises(unittest.TestCase):
    def test_a_broken_promise_exits_1_with_a_line_that_replays_it(self):
        done = run("sweep", "--count", "200", "--json", "-", program=BROKEN_PROGRAM)
        self.assertEqual(done.returncode, 1)
        result = json.loads(done.stdout)
        VALIDATOR.validate(result)
        broken = {row["kernel"]: {b["property"]: b["index"] for b in row["broken_promises"]}
                  for row in result["rows"]}
        self.assertIn("psd", broken[ENERGY + "/analytic/f64"])
        found = re.findall(r"(\S+) promises to be psd and is not:\n  definite (replay .*)\n",
                           done.stderr)
        self.assertEqual([name for name, _ in found],
                         [ENERGY + "/analytic/f64", ENERGY + "/analytic/f64x8"])
        for name, command in found:
            again = run(*command.split(), program=BROKEN_PROGRAM)
            self.assertEqual(again.returncode, 1)
            self.assertIn(f"index {broken[name]['psd']}\n", again.stdout)
            self.assertEqual(again.stderr.count(f"{name} promises to be psd and is not\n"), 1)

    def test_the_line_that_replays_it_has_what_was_set(self):
        done = run("sweep", "--count", "200", "--set", "side=-1", "--set", "eps=0.0625",
                   program=BROKEN_PROGRAM)
        self.assertEqual(done.returncode, 1)
        found = re.findall(r"psd and is not:\n  definite (replay .*)\n", done.stderr)
        self.assertNotEqual(found, [])
        for command in found:
            self.assertTrue(command.endswith(" --set side=-1 --set eps=0.0625"), command)
            again = run(*command.split(), program=BROKEN_PROGRAM)
            self.assertEqual(again.returncode, 1)
            self.assertIn("psd and is not\n", again.stderr)

    def test_the_line_that_replays_it_quotes_a_path(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "it's mine.csv"
            path.write_text("# stencil=vertex_face eps=1\n"
                            "x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3\n"
                            "0.3,0.3,0.1,1,0,0,0,0,0,0,1,0\n")
            done = run("sweep", "--no-timing", "--distribution", str(path), program=BROKEN_PROGRAM)
            self.assertEqual(done.returncode, 1, done.stderr)
            found = re.findall(r"psd and is not:\n  definite (replay .*)\n", done.stderr)
            self.assertNotEqual(found, [])
            for command in found:
                words = shlex.split(command)
                self.assertIn(str(path), words)
                again = run(*words, program=BROKEN_PROGRAM)
                self.assertEqual(again.returncode, 1, again.stderr)
                self.assertIn("psd and is not\n", again.stderr)

    def test_what_a_filter_does_not_promise_exits_0(self):
        none = ENERGY + "/none/f64"
        for program in (PROGRAM, BROKEN_PROGRAM):
            done = run("sweep", "--count", "1000", "--kernels", none, "--json", "-",
                       program=program)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            row = json.loads(done.stdout)["rows"][0]
            self.assertGreater(row["verdicts"]["non_psd"], 0)
            self.assertEqual(row["broken_promises"], [])
            replay = run("replay", "--kernel", none, "--index", "0", program=program)
            self.assertEqual((replay.returncode, replay.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
