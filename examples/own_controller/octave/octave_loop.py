#!/usr/bin/env python3
"""Runs a law in Octave as a position loop: octave_loop.py LAW, for LAW.m in this folder. It hands each state over a pipe."""
import os
import struct
import subprocess
import sys

import hydro_bus
from hydro import pressure_command_t

# Hexadecimal doubles on the way there, all 17 digits on the way back: not a bit is lost.
SERVE = """
addpath('{folder}');
while true
  try, line = input('', 's'); catch, break; end  % the end of the pipe
  inputs = hex2num(strsplit(line, ' '));
  printf('%.17g\\n', {law}(inputs(1), inputs(2)));
  fflush(stdout);
end
"""
folder, law = os.path.dirname(os.path.abspath(__file__)), sys.argv[1]
octave = subprocess.Popen(["octave-cli", "--quiet", "--no-init-file", "--no-history", "--eval", SERVE.format(folder=folder, law=law)],
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def ask(*inputs):
    octave.stdin.write(" ".join(struct.pack(">d", value).hex() for value in inputs) + "\n")
    octave.stdin.flush()
    return float(octave.stdout.readline())


def answer(state, command):
    command.pressure_ref = ask(state.arm_angle, state.arm_speed)


ask(0, 0)  # Octave has started before the loop says that it is ready
code = hydro_bus.Loop(hydro_bus.Bus(), "position_ctrl", "HYDRO_PRESSURE_COMMAND", pressure_command_t, answer, every=5).run()
octave.stdin.close()
octave.wait()
sys.exit(code)
