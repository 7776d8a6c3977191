"""What hydro-log export writes, read by the tools that people have, value by value against the log.

Runs with Debian's own python3, for its h5py, SciPy and pandas; a tool that is missing skips its tests with a message."""

import importlib.util
import json
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "e2e"))
import event_log  # noqa: E402
import outcome  # noqa: E402

BIN = os.environ["HYDRO_BIN"]
CONFIG = os.path.join(os.environ["HYDRO_CONFIG"], "demo.toml")
sys.path.insert(0, os.environ["HYDRO_PYTHON"])
import hydro  # noqa: E402

CHANNELS = ("HYDRO_STATE", "HYDRO_MOTOR_COMMAND", "HYDRO_PRESSURE_COMMAND", "HYDRO_ARM_REFERENCE", "HYDRO_RUN", "HYDRO_FAULT",
            "HYDRO_LOOP_HISTOGRAM", "HYDRO_SETTINGS")
PSI_IN_PA = 0.45359237 * 9.80665 / 0.0254**2


def needs(module):
    """Skips where Python has no such module."""
    return unittest.skipUnless(importlib.util.find_spec(module), f"python3-{module} is not installed")


def same(a, b):
    """Equal, with NaN equal to itself, and lists element by element."""
    if isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(b, float) and math.isnan(b):
        return math.isnan(float(a))
    return a == b


def run(*command, expect=0, **options):
    done = subprocess.run([str(one) for one in command], capture_output=True, timeout=120, check=False, **options)
    if done.returncode != expect:
        raise AssertionError(f"{command}: exit {done.returncode}, expected {expect}\n{done.stderr.decode()[-2000:]}")
    return done


def odd_messages():
    """A fault whose text needs quotes and has letters beyond ASCII, one without a number, a histogram and settings with lists, and empty ones."""
    nan = float("nan")
    fault = dict(utime=0, tick=7, session=-5, sequence=0, source="plant", code="stale", text='p1 is "high", 3 µ over\nthe limit ☂ 𝄞',
                 value=2100.25, limit=2000.0, latched=True, active=True)
    yield 20, "HYDRO_FAULT", hydro.fault_t, fault
    yield 30, "HYDRO_FAULT", hydro.fault_t, dict(fault, tick=-1, sequence=1, text="", value=nan, limit=nan, latched=False)
    counts = dict(bucket_first=[1, 2, 2**62], bucket_last=[1, 3, 2**62 + 5], bucket_count=[4, 5, 6], buckets=3)
    histogram = dict(utime=1, session=3, sequence=0, role="plant", host="vm", quantity="period", whole_run=False, interval_s=0.5,
                     count=15, lowest=1, highest=2**62)
    yield 40, "HYDRO_LOOP_HISTOGRAM", hydro.loop_histogram_t, dict(histogram, **counts)
    yield 50, "HYDRO_LOOP_HISTOGRAM", hydro.loop_histogram_t, dict(histogram, sequence=1, buckets=0, bucket_first=[], bucket_last=[],
                                                                    bucket_count=[])


def write_odd_log(path, sim_log):
    """The simulated run with messages in it that the simulator does not send, as lcm-logger would have recorded them; a state is
    repeated and a value is missing."""
    events = event_log.read_events(sim_log)
    for place, channel, type_, values in odd_messages():
        message = type_()
        for name, value in values.items():
            setattr(message, name, value)
        events.insert(place, event_log.Event(0, events[place].utime, channel, message.encode()))
    states = [at for at, event in enumerate(events) if event.channel == "HYDRO_STATE"]
    state = hydro.state_t.decode(events[states[9]].data)
    state.p2 = float("nan")
    events[states[9]] = events[states[9]]._replace(data=state.encode())
    events.insert(states[12], events[states[12]])
    event_log.write_plain(path, events)


class ForeignReadersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.sim = cls.path("sim.lcmlog")
        run(os.path.join(BIN, "hydro-sim"), CONFIG, "--duration", "0.1", "-o", cls.sim)
        cls.log = cls.path("odd.lcmlog")
        write_odd_log(cls.log, cls.sim)
        cls.messages = {channel: [] for channel in CHANNELS}
        for event in event_log.read_events(cls.log):
            if event.channel in cls.messages:
                cls.messages[event.channel].append((event.utime, event_log.TYPES[event.channel].decode(event.data)))
        cls.csv = cls.path("odd.csv")
        cls.export(cls.log, "-o", cls.csv)
        with open(cls.csv, encoding="utf-8") as file:
            names, *rows = (line.rstrip("\n").split(",") for line in file)
        cls.table = {name: [float(row[k] or "nan") for row in rows] for k, name in enumerate(names)}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @classmethod
    def export(cls, *arguments, **options):
        return run(os.path.join(BIN, "hydro-log"), "export", *arguments, **options)

    def channel(self, name):
        """A channel's fields as lists, with the time of receipt."""
        received, messages = zip(*self.messages[name])
        columns = {field: [getattr(message, field) for message in messages] for field in messages[0]._fields}
        return dict(columns, received_us=list(received))

    def assert_same(self, found, expected, what):
        self.assertEqual(len(found), len(expected), what)
        for row, (a, b) in enumerate(zip(found, expected)):
            self.assertTrue(same(a, b), f"{what}, row {row}: found {a!r}, the log has {b!r}")

    def assert_holds(self, names, column):
        """Compares all channels and the table; column(channel or None, field) gives the values read."""
        for name, expected in self.table.items():
            self.assert_same(column(None, name), expected, name)
        for channel in names:
            for field, expected in self.channel(channel).items():
                self.assert_same(column(channel, field), expected, f"{channel}.{field}")

    # Tests that the log holds what the other tests are for.
    def test_log(self):
        for channel in CHANNELS:
            self.assertGreaterEqual(len(self.messages[channel]), 2, channel)
        self.assertEqual(len(self.table["tick"]), 101)
        self.assertEqual(len(self.messages["HYDRO_STATE"]), 102)
        self.assertTrue(math.isnan(self.table["p2_psi"][9]))

    # Tests every message, the table, units, sources, the configuration and the checksums of an MCAP file, and the same file through a pipe.
    def test_mcap(self):
        if not shutil.which("node"):
            self.skipTest("node is not installed")
        file = self.path("odd.mcap")
        self.export(self.log, "-o", file)
        found = json.loads(run("node", os.path.join(HERE, "mcap_reader.mjs"), file).stdout)
        exact = {"topics": {}}
        for topic, read in found["topics"].items():
            self.assertEqual(int(read["count"]), len(read["messages"]), topic)
            self.assertEqual(read["encoding"], "cdr")
            exact["topics"][topic] = read["messages"]

        def number(value, like):
            if isinstance(like, (list, tuple)):
                return [number(one, other) for one, other in zip(value, like)]
            return float(value) if isinstance(like, float) else int(value) if isinstance(like, int) else value

        for channel in CHANNELS:
            messages = exact["topics"]["/" + channel.lower().replace("_", "/", 1)]
            expected = self.channel(channel)
            for field, values in expected.items():
                if field == "received_us":
                    read = [int(message["@log"]) // 1000 for message in messages]
                else:
                    read = [number(message[field], value) for message, value in zip(messages, values)]
                self.assert_same(read, values, f"{channel}.{field}")
        table = exact["topics"]["/hydro/table"]
        for name, values in self.table.items():
            self.assert_same([float(message[name.lower()]) for message in table], values, name)
        state = found["topics"]["/hydro/state"]
        self.assertEqual(state["metadata"]["unit.p1"], "psi")
        self.assertIn("odd.lcmlog", state["metadata"]["source"])
        self.assertIn("float64 p1  # [psi] pressure of side 1", state["schema"])
        self.assertIn("int8 OPEN_LOOP=1", found["topics"]["/hydro/motor_command"]["schema"])
        self.assertEqual(state["type"], "hydro_msgs/msg/State")
        self.assertEqual(found["metadata"]["hydro"]["recorded_by"], "hydro-sim")
        self.assertEqual(found["attachments"]["config.toml"], self.messages["HYDRO_RUN"][0][1].config_text)
        self.assertEqual(found["attachments"]["model.toml"], self.messages["HYDRO_RUN"][0][1].model_text)
        everything = sum(len(messages) for messages in exact["topics"].values())
        self.assertEqual((found["streamed"], int(found["statistics"]["messages"]), found["streamDone"]), (everything, everything, True))
        piped = self.export(self.log, "--format", "mcap", "-o", "-").stdout
        with open(file, "rb") as whole:
            self.assertEqual(piped, whole.read())

    # Tests that two runs in one MCAP file have topics of their own, and that many chunks are all indexed.
    def test_mcap_of_two_runs(self):
        if not shutil.which("node"):
            self.skipTest("node is not installed")
        long = self.path("long.lcmlog")
        run(os.path.join(BIN, "hydro-sim"), CONFIG, "--duration", "4", "-o", long)
        file = self.path("two.mcap")
        self.export(long, self.log, "-o", file)
        found = json.loads(run("node", os.path.join(HERE, "mcap_reader.mjs"), file).stdout)
        self.assertGreater(found["chunks"], 1)
        states = found["topics"]["/long/hydro/state"]["messages"]
        self.assertEqual([int(state["tick"]) for state in states], list(range(4001)))
        self.assertEqual(len(found["topics"]["/odd/hydro/state"]["messages"]), 102)
        self.assertIn("hydro/odd", found["metadata"])
        self.assertEqual(found["streamed"], sum(int(topic["count"]) for topic in found["topics"].values()))

    # Tests every column of an HDF5 file with its attributes.
    @needs("h5py")
    def test_hdf5(self):
        import h5py
        file = self.path("odd.h5")
        self.export(self.log, "--all-channels", "-o", file)
        with h5py.File(file) as read:
            def column(channel, field):
                values = (read if channel is None else read[channel])[field]
                if h5py.check_string_dtype(values.dtype):
                    return list(values.asstr()[()])
                lists = h5py.check_vlen_dtype(values.dtype)
                return [[x.decode() if isinstance(x, bytes) else x for x in row] if lists else row.item() for row in values[()]]

            self.assert_holds(CHANNELS, column)
            self.assertEqual(read["HYDRO_STATE/p1"].attrs["unit"], "psi")
            self.assertEqual(read["p1_psi"].attrs["unit"], "psi")
            self.assertIn("pressure of side 1", read["HYDRO_STATE/p1"].attrs["description"])
            self.assertIn("odd.lcmlog", read["HYDRO_STATE"].attrs["source"])
            self.assertEqual(read.attrs["config"], self.messages["HYDRO_RUN"][0][1].config_text)
            self.assertTrue(read["HYDRO_MOTOR_COMMAND"].attrs["OPEN_LOOP"].startswith("1: voltage passed through"))
            # Plant time: that of the message's tick, and of the state before a message without one.
            times = dict(zip(self.table["tick"], self.table["time_s"]))
            commands = self.channel("HYDRO_MOTOR_COMMAND")["tick"]
            self.assert_same(list(read["HYDRO_MOTOR_COMMAND/time_s"][()]), [times[min(tick, 100)] for tick in commands], "time_s")
            self.assertEqual(read["HYDRO_FAULT/time_s"][0], times[7])

    # Tests a struct for each channel in MAT 5.
    @needs("scipy")
    def test_mat5(self):
        import scipy.io
        file = self.path("odd.mat")
        self.export(self.log, "--all-channels", "-o", file)
        read = scipy.io.loadmat(file, chars_as_strings=True)

        def text(value):
            return str(value[0]).replace("\ufffd", "𝄞") if value.size else ""  # which MAT 5 leaves out (docs/logs.md)

        def column(channel, field):
            values = read[field] if channel is None else read[channel][field][0, 0]
            self.assertEqual(values.shape[1], 1, field)
            if values.dtype != object:
                return [value.item() for value in values[:, 0]]
            cells = values[:, 0]
            if all(cell.dtype.kind == "U" for cell in cells):
                return [text(cell) for cell in cells]
            return [[text(x[0]) if cell.dtype == object else x[0].item() for x in cell] for cell in cells]

        self.assert_holds(CHANNELS, column)
        state = read["HYDRO_STATE"][0, 0]
        self.assertEqual(state["tick"].dtype, "int64")
        self.assertEqual(text(state["units"][0, 0]["p1"]), "psi")
        self.assertIn("odd.lcmlog", text(state["exported_from"]))
        # The table alone: its columns and nothing else.
        self.export(self.log, "-o", file, "--force")
        self.assertEqual([name for name in scipy.io.loadmat(file) if not name.startswith("__")], list(self.table))

    # Tests the same in MAT 7.3, by the rules by which MATLAB reads it: its classes, its order of dimensions, references to cells.
    @needs("h5py")
    def test_mat73(self):
        import h5py
        file = self.path("odd73.mat")
        self.export(self.log, "--all-channels", "--format", "mat73", "-o", file)
        with open(file, "rb") as whole:
            head = whole.read(128)
        self.assertTrue(head.startswith(b"MATLAB 7.3 MAT-file"))
        self.assertEqual(head[124:], b"\x00\x02IM")
        with h5py.File(file) as read:
            def value(dataset):
                kind = dataset.attrs["MATLAB_class"].decode()
                if "MATLAB_empty" in dataset.attrs:
                    return "" if kind == "char" else []
                if kind == "char":
                    return dataset[()].T.tobytes().decode("utf-16-le")
                if kind == "cell":
                    return [value(read[cell]) for cell in dataset[0]]
                self.assertEqual(dataset.shape[0], 1)
                return [one.item() for one in dataset[0]]

            self.assert_holds(CHANNELS, lambda channel, field: value((read if channel is None else read[channel])[field]))
            state = read["HYDRO_STATE"]
            self.assertEqual(state.attrs["MATLAB_class"], b"struct")
            self.assertEqual([b"".join(name).decode() for name in state.attrs["MATLAB_fields"]][:4],
                             ["time_s", "received_us", "utime", "tick"])
            self.assertEqual(state["tick"].attrs["MATLAB_class"], b"int64")
            self.assertEqual(read["HYDRO_MOTOR_COMMAND/saturated"].attrs["MATLAB_class"], b"logical")
            self.assertEqual(value(state["units/p1"]), "psi")

    # Tests that Octave loads MAT 5 with structs, cells and texts, and the columns of MAT 7.3 and of HDF5.
    @unittest.skipUnless(shutil.which("octave-cli"), "octave is not installed")
    def test_octave(self):
        self.export(self.log, "--all-channels", "-o", self.path("octave.mat"))
        self.export(self.log, "--format", "mat73", "-o", self.path("octave73.mat"))
        self.export(self.log, "-o", self.path("octave.h5"))
        script = f"""
            a = load('{self.path("octave.mat")}'); b = load('{self.path("octave73.mat")}'); c = load('{self.path("octave.h5")}');
            for [values, name] = b  % the table's columns
              printf('%s', name); printf(' %.17g', a.(name)); printf('\\n');
              if !isequaln(values(:), a.(name)) || !isequaln(c.(name)(:), a.(name)) error('%s differs', name); end
            end
            printf('tick'); printf(' %d', a.HYDRO_MOTOR_COMMAND.tick); printf('\\n');
            printf('units %s\\n', a.HYDRO_STATE.units.p1);
            printf('text %s\\n', a.HYDRO_FAULT.code{{1}});
            printf('list'); printf(' %d', a.HYDRO_LOOP_HISTOGRAM.bucket_last{{1}}); printf('\\n');
        """
        out = run("octave-cli", "--norc", "--no-history", "--eval", script).stdout.decode().splitlines()
        *columns, tick, units, text, numbers = (line.split() for line in out)
        self.assertEqual(sorted(column[0] for column in columns), sorted(self.table))
        for name, *values in columns:
            self.assert_same([float(value) for value in values], self.table[name], name)
        self.assertEqual([int(value) for value in tick[1:]], self.channel("HYDRO_MOTOR_COMMAND")["tick"])
        self.assertEqual((units[1], text[1], numbers[1:]), ("psi", "stale", ["1", "3", str(2**62 + 5)]))

    # Tests CSV of a channel: texts with commas, quotes and line ends, lists, units in the names; and of several runs.
    @needs("pandas")
    def test_csv(self):
        import pandas
        self.export(self.log, "--channel", "HYDRO_FAULT", "-o", self.path("fault.csv"))
        fault = pandas.read_csv(self.path("fault.csv"), keep_default_na=False)
        expected = self.channel("HYDRO_FAULT")
        self.assertEqual(list(fault["text"]), expected["text"])
        self.assertEqual(list(fault["active"]), expected["active"])
        self.export(self.log, "--channel", "HYDRO_LOOP_HISTOGRAM", "-o", self.path("histogram.csv"))
        histogram = pandas.read_csv(self.path("histogram.csv"), keep_default_na=False)
        self.assertEqual([[int(x) for x in cell.split()] for cell in histogram["bucket_last"]],
                         [list(row) for row in self.channel("HYDRO_LOOP_HISTOGRAM")["bucket_last"]])
        self.export(self.log, self.sim, "--channel", "HYDRO_STATE", "-o", self.path("two.csv"))
        two = pandas.read_csv(self.path("two.csv"), float_precision="round_trip")
        self.assert_same(list(two.query("run == 'odd'")["p1_psi"]), self.channel("HYDRO_STATE")["p1"], "p1_psi")
        self.assertEqual(len(two.query("run == 'sim'")), 101)
        # A folder has a table for each, and of several runs in each.
        self.export(self.log, "--all-channels", "-o", self.path("tables/"))
        files = sorted(os.listdir(self.path("tables")))
        self.assertIn("table.csv", files)
        self.assertIn("HYDRO_FAULT.csv", files)
        for name, column in (("table", "p2_psi"), ("HYDRO_STATE", "p2_psi"), ("HYDRO_MOTOR_COMMAND", "voltage_V")):
            read = pandas.read_csv(self.path(f"tables/{name}.csv"), float_precision="round_trip")
            expected = self.table if name == "table" else self.channel(name)
            self.assert_same(list(read[column]), expected[column if name == "table" else column.rsplit("_", 1)[0]], name)
        self.export(self.log, self.sim, "--channel", "HYDRO_STATE", "--channel", "table", "-o", self.path("both/"))
        self.assertEqual(sorted(os.listdir(self.path("both"))), ["HYDRO_STATE.csv", "table.csv"])
        self.assertEqual(set(pandas.read_csv(self.path("both/table.csv"))["run"]), {"odd", "sim"})
        refused = self.export(self.log, "--all-channels", "-o", self.path("both/"), expect=2)
        self.assertIn(b"there already", refused.stderr)

    # Tests --si in every format: pressures in Pa, to the last bit the same, and the names and units say so.
    @needs("h5py")
    def test_si(self):
        import h5py
        self.export(self.log, "--all-channels", "--si", "-o", self.path("si.h5"))
        with h5py.File(self.path("si.h5")) as read:
            self.assertEqual(read["HYDRO_STATE/p1"].attrs["unit"], "Pa")
            self.assertEqual(read["HYDRO_STATE/motor_speed"].attrs["unit"], "rad/s")
            psi = self.channel("HYDRO_STATE")["p1"]
            for found, expected in zip(read["HYDRO_STATE/p1"][()], psi):
                self.assertAlmostEqual(found, expected * PSI_IN_PA, delta=1e-15 * abs(found) * 4)
            self.assertEqual(len(read["p1_Pa"]), 101)
            self.assertNotIn("p1_psi", read)
            self.assert_same(list(read["motor_speed_rad_s"][()]), self.table["motor_speed_rad_s"], "motor_speed")

    # Tests that a reader of the pipe that goes away ends the program without a word, and that a pipe takes every format.
    def test_pipes(self):
        for form in ("csv", "mcap", "hdf5", "mat", "mat73"):
            with self.subTest(form):
                program = subprocess.Popen([os.path.join(BIN, "hydro-log"), "export", self.log, "-o", "-", "--format", form],
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                program.stdout.close()
                self.assertEqual(program.stderr.read(), b"")
                program.stderr.close()
                self.assertIn(program.wait(), (-13, 0))
                if form == "csv":
                    continue
                whole = self.path("piped." + form)
                self.export(self.log, "-o", whole, "--format", form)
                with open(whole, "rb") as file:
                    self.assertEqual(self.export(self.log, "-o", "-", "--format", form).stdout, file.read())

    # Tests that a disk that fills up ends each format with one line and exit 1, and leaves no file.
    def test_full_disk(self):
        def little_room():
            resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

        for form in ("csv", "mcap", "hdf5", "mat", "mat73"):
            with self.subTest(form):
                done = self.export(self.log, "-o", self.path("full"), "--format", form, expect=1, preexec_fn=little_room)
                self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
                self.assertIn(b"full: cannot be written", done.stderr)
                self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("full")], [])

    # Tests that an export never replaces its log, and that CSV takes one table.
    def test_refused(self):
        with open(self.log, "rb") as file:
            before = file.read()
        for arguments in ((self.log, "-o", self.log, "--format", "csv"), (self.sim, self.log, "-o", self.log, "--format", "mcap"),
                          (self.log, "--all-channels", "-o", self.path("all.csv")), (self.log, "-o", self.path("x.parquet")),
                          (self.log, "--channel", "HYDRO_STATE", "--all-channels", "-o", self.path("x.h5"))):
            with self.subTest(arguments[-3:]):
                done = self.export(*arguments, expect=2)
                self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
                self.assertIn(b"allowed", done.stderr)
        with open(self.log, "rb") as file:
            self.assertEqual(file.read(), before)
        self.assertFalse(os.path.exists(self.path("all.csv")))


if __name__ == "__main__":
    outcome.main()
