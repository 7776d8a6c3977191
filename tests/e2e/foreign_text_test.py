"""Text that is not UTF-8, from the network and in names of files: every JSON stays JSON, and nobody ends of it."""

import json
import os
import re
import signal
import struct

import event_log
import fault_case
import outcome
import stack

# A surrogate, an overlong form, a byte that occurs in no character, and a truncated character. Each of them
# once ended a writer of JSON.
WRONG = b"\xed\xa0\x80 \xc0\xaf \xff \xe2\x82"
PLACE = "placeholder"  # as long as WRONG


class ForeignTextTest(fault_case.FaultCase):
    def fault(self, hashes, **fields):
        """A HYDRO_FAULT whose source, code and text are WRONG."""
        self.assertEqual(len(PLACE), len(WRONG))
        type_ = event_log.TYPES["HYDRO_FAULT"]
        fields.update(source=PLACE, code=PLACE, text=PLACE)
        values = [fields.get(name, "" if code == "s" else 0) for name, code in zip(type_.tuple._fields, type_.codes)]
        return type_.encode(hashes["HYDRO_FAULT"], values).replace(PLACE.encode(), WRONG)

    def fault_hashes(self):
        """Those of a sample, and of a fault, of which a sample has none."""
        with open(os.path.join(stack.CONFIG, "demo.toml"), encoding="utf-8") as file:
            config = file.read().replace("models/table1.toml", os.path.join(stack.CONFIG, "models", "table1.toml"))
        with open(self.path("faulty.toml"), "w", encoding="utf-8") as file:
            file.write(config)
        log = self.path("faulty.lcmlog")
        self.run_program("hydro-sim", self.path("faulty.toml"), "--set", "limits.motor_speed_rad_s=1", "-o", log, expect=1)
        hashes = {event_log.kind_of(event.channel): event.data[:8] for event in event_log.read_events(log)}
        self.assertIn("HYDRO_FAULT", hashes)
        return hashes

    def objects(self, path):
        """The objects of a file with one on each line; strictly UTF-8."""
        with open(path, "rb") as file:
            return [json.loads(line) for line in file.read().decode("utf-8", "strict").splitlines()]

    # Tests that hydro-launch --json continues after such faults, from strangers and in the name of its own
    # plant, and ends in order.
    def test_launch(self):
        hashes = self.fault_hashes()
        out = self.path("launch.jsonl")
        launcher = self.start("/bin/sh", "-c", 'out=$1; shift; exec "$@" > "$out"', "sh", out, stack.program("hydro-launch"),
                              self.moving(), "--time", "realtime", "--duration", "0", "--json", "--set", f"bus.url={self.url}",
                              label="hydro-launch")
        peer = self.peer()
        sessions = []

        def plant():
            sessions.extend(event_log.TYPES["HYDRO_STATE"].decode(data).session
                            for channel, data in peer.receive(0.1) if channel == "HYDRO_STATE")
            return sessions

        self.wait_until(plant, "a state")

        def shown():
            for session in (sessions[-1], 77):
                peer.publish_bytes("HYDRO_FAULT", self.fault(hashes, session=session, tick=1, sequence=1, active=1))
            peer.receive(0.2)
            return any(row["fault"] for line in self.objects_so_far(out) for row in line.get("processes", []))

        self.wait_until(shown, "the fault in the status")
        launcher.send(signal.SIGINT)
        self.assertEqual(launcher.wait(), 1, launcher.report())  # the fault has not gone
        lines = self.objects(out)
        self.assertEqual(lines[-1]["exit_code"], 1)
        self.assertTrue(any(r"\xed\xa0\x80 \xc0\xaf \xff \xe2\x82" in line.get("text", "") for line in lines), lines[-5:])
        self.assertTrue(any("\ufffd" in row["fault"] for line in lines for row in line.get("processes", [])))

    def objects_so_far(self, path):
        with open(path, "rb") as file:
            text = file.read().decode("utf-8", "strict")
        return [json.loads(line) for line in text[:text.rfind("\n") + 1].splitlines()]

    # Tests the JSON and the text of hydro-log for a log with such a message and such a name.
    def test_log(self):
        hashes = self.fault_hashes()
        name = os.fsdecode(os.fsencode(self.folder) + b"/run\xff\xed\xa0\x80.lcmlog")
        events = [(event.utime, event.channel, event.data) for event in event_log.read_events(self.path("faulty.lcmlog"))]
        events.append((events[-1][0], "HYDRO_FAULT", self.fault(hashes, session=5, tick=3, sequence=1, active=1)))
        with open(name, "wb") as file:
            for number, (utime, channel, data) in enumerate(events):
                file.write(struct.pack(">IqqII", 0xEDA1DA01, number, utime, len(channel), len(data)) + channel.encode() + data)
        for verb in ("info", "summary"):
            out = self.path(verb + ".json")
            json_options = ["--json", out] if verb == "summary" else ["--json"]
            process = self.start("/bin/sh", "-c", 'out=$1; shift; exec "$@" > "$out"', "sh",
                                 os.devnull if verb == "summary" else out, stack.program("hydro-log"), verb, name, *json_options)
            self.assertIn(process.wait(), (0, 1), process.report())
            with open(out, "rb") as file:
                found = json.loads(file.read().decode("utf-8", "strict"))
            self.assertTrue(any("\ufffd" in fault["code"] for fault in found["faults"]), found["faults"])
            text = self.start("hydro-log", verb, name)
            self.assertIn(text.wait(), (0, 1), text.report())
            self.assertTrue(re.search(r"\\xed\\xa0\\x80 \\xc0\\xaf \\xff", text.stdout), text.report())
            self.assertNotIn("\ufffd", text.stdout, "bytes that are not UTF-8 reach the terminal")


if __name__ == "__main__":
    outcome.main()
