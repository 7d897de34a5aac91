#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark analyze --setup beside OpenSim's AnalyzeTool and InverseDynamicsTool, on the same setup files.

The motion is made of sine waves about the mean of a stored one, so that it has rates that both must find. Compared are
coordinates, speeds, positions and velocities of bodies and of a point, torques with and without forces under the feet, with and
without OpenSim's low-pass. AnalyzeTool's accelerations are those of forward dynamics of the model without its actuators, not the
motion's, so ours are compared with the waves' own (coordinates) and with differences of OpenSim's velocities (bodies).

Needs Python with opensim. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import inverse_dynamics_opensim as feet
from mot_opensim import CASES, DATA, PROGRAM, coordinates_of, make_motion, place, read_table, row

RATE_HZ, FRAMES, RIM = 100.0, 101, 12  # the rim is not compared: both programs lack a neighbour there
ALIKE = 1e-4       # of the largest value of its table: rates are estimates of both programs, ours of a smoother
FILTERED = 1e-3    # the same behind a low-pass, whose ends differ
DIFFERENCES = 2e-3  # of differences of the judge's velocities, 10 ms apart
ANALYZE = """<AnalyzeTool name="judge"><model_file>{model}</model_file><replace_force_set>false</replace_force_set>
<results_directory>{out}</results_directory><output_precision>16</output_precision>
<initial_time>0.055</initial_time><final_time>0.95</final_time><coordinates_file>motion.mot</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>{cutoff}</lowpass_cutoff_frequency_for_coordinates>
<AnalysisSet><objects><Kinematics name="K"><coordinates>all</coordinates></Kinematics>
<BodyKinematics name="B"><bodies>all</bodies></BodyKinematics>
<BodyKinematics name="L"><on>{local}</on><bodies>{body} center_of_mass</bodies><in_degrees>false</in_degrees>
<express_results_in_body_local_frame>true</express_results_in_body_local_frame></BodyKinematics>
<PointKinematics name="P"><body_name>{body}</body_name><relative_to_body_name>pelvis</relative_to_body_name>
<point_name>point</point_name><point>0.01 0.02 0.03</point></PointKinematics></objects></AnalysisSet></AnalyzeTool>"""
DYNAMICS = """<InverseDynamicsTool name="judge"><results_directory>{out}</results_directory><model_file>{model}</model_file>
<time_range>0.05 0.95</time_range><forces_to_exclude>Muscles</forces_to_exclude>{loads}
<coordinates_file>motion.mot</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>{cutoff}</lowpass_cutoff_frequency_for_coordinates>
<output_gen_force_file>tau.sto</output_gen_force_file></InverseDynamicsTool>"""


def write_setup(path, content):
    path.write_text(f'<?xml version="1.0" encoding="UTF-8"?>\n<OpenSimDocument Version="40000">{content}</OpenSimDocument>\n')
    return path


def write_motion(opensim, model_file, stored, folder):
    """motion.mot as OpenSim writes it, model.osim in its own version, and the truth's accelerations."""
    model = opensim.Model(str(model_file))
    state = model.initSystem()
    coordinates = coordinates_of(model)
    storage = opensim.Storage(FRAMES, "Coordinates")
    labels = opensim.ArrayStr()
    for name in ["time", *(c.getName() for c in coordinates)]:
        labels.append(name)
    storage.setColumnLabels(labels)
    for f, frame in enumerate(make_motion(stored, coordinates, opensim)):
        place(model, state, coordinates, frame)
        line = opensim.Vector(len(coordinates), 0.0)
        for i, coordinate in enumerate(coordinates):
            line.set(i, coordinate.getValue(state))
        storage.append(f / RATE_HZ, line)
    model.getSimbodyEngine().convertRadiansToDegrees(storage)
    opensim.IO.SetPrecision(16)
    storage.printToFile(str(folder / "motion.mot"), "w", "")
    return model


def ours(setup, folder):
    done = subprocess.run([PROGRAM, "analyze", "--setup", setup, "--output", folder], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr)


def worst_of(theirs, ours_, columns=None):
    """(largest |difference| over the largest value, its column) of two tables of the same rows, away from the rim."""
    if list(theirs) != list(ours_) or len(theirs["time"]) != len(ours_["time"]):
        return math.inf, f"other columns ({sorted(set(theirs) ^ set(ours_))}) or rows ({len(theirs['time'])} and {len(ours_['time'])})"
    size = max(abs(v) for name, values in theirs.items() if name != "time" for v in values) or 1.0
    return max((max(abs(a - b) for a, b in list(zip(theirs[c], ours_[c]))[RIM:-RIM]) / size, c) for c in columns or theirs)


def compare(name, files, bound, theirs, mine):
    worst = max((*worst_of(read_table(theirs / f), read_table(mine / f)), f) for f in files)
    return row(worst[0] <= bound, name, f"{len(files)} tables, same rows and labels, at most {bound:.0e} of the largest value",
               f"{worst[0]:.1e} ({worst[2]}, {worst[1]})")


def compare_torques(name, bound, theirs, mine, speeds):
    """Torques by their names. OpenSim leaves a coupled coordinate the force that its own body needs; we add it to the coordinate
    that drives it, where the power is the same. So powers are compared there: theirs of both, and ours."""
    judge, own, u = read_table(theirs), read_table(mine), read_table(speeds)
    if set(judge) != set(own) or len(judge["time"]) != len(own["time"]):
        return row(False, name, "the same columns and rows", f"{sorted(set(judge) ^ set(own))}")
    worst, largest = (0.0, "none"), max(abs(v) for c, values in judge.items() if c != "time" for v in values)
    for column in (c for c in judge if c != "time" and not c.endswith("_beta_force")):
        pairs = list(zip(judge[column], own[column]))
        coordinate = column.rsplit("_", 1)[0]
        driven = judge.get(coordinate + "_beta_force")
        if driven:
            fast = max(abs(v) for v in u[coordinate])
            pairs = [((a * v + b * w) / fast, c * v / fast)
                     for a, b, c, v, w in zip(judge[column], driven, own[column], u[coordinate], degrees_of(u, coordinate + "_beta"))]
        worst = max(worst, (max(abs(a - b) for a, b in pairs[RIM:-RIM]) / largest, column))
    return row(worst[0] <= bound, name, f"{len(judge) - 1} columns, same rows, at most {bound:.0e} of the largest",
               f"{worst[0]:.1e} ({worst[1]})")


def degrees_of(speeds, coordinate):
    """A coordinate that keeps radians, in degrees."""
    return [math.degrees(v) for v in speeds[coordinate]]


def acceleration_rows(name, theirs, mine):
    """Our accelerations against differences of OpenSim's velocities over two frames, which miss third derivatives by h^2 / 6."""
    good = True
    for what, suffix in (("coordinates", "K_{}.sto"), ("bodies", "B_{}_global.sto")):
        rate, second = ("u", "dudt") if what == "coordinates" else ("vel", "acc")
        v, a = read_table(theirs / ("judge_" + suffix.format(rate))), read_table(mine / ("judge_" + suffix.format(second)))
        size = max(abs(x) for c, values in a.items() if c != "time" for x in values)
        differences = {c: [math.nan, *(0.5 * RATE_HZ * (y - x) for x, y in zip(values, values[2:])), math.nan] for c, values in v.items()}
        worst = max((max(abs(x - y) for x, y in list(zip(differences[c], a[c]))[RIM:-RIM]) / size, c) for c in a if c != "time")
        good &= row(worst[0] <= DIFFERENCES, f"{name}: accelerations of {what} against differences of OpenSim's velocities",
                    f"at most {DIFFERENCES:.0e} of the largest", f"{worst[0]:.1e} ({worst[1]})")
    return good


def check_case(opensim, name, scratch):
    original, stored = (DATA / path for path in CASES[name])
    folder = scratch / name
    folder.mkdir()
    os.chdir(folder)  # InverseDynamicsTool takes names from where it runs
    model_file = folder / "model.osim"
    opensim.Model(str(original)).printToXML(str(model_file))
    model = write_motion(opensim, model_file, read_table(stored), folder)
    body = model.getBodySet().get(model.getBodySet().getSize() - 1).getName()
    good = True
    for cutoff, bound in ((-1, ALIKE), (6, FILTERED)):
        theirs, mine = folder / f"theirs{cutoff}", folder / f"ours{cutoff}"
        fill = {"model": "model.osim", "body": body, "cutoff": cutoff}
        both = [write_setup(folder / f"analyze{local}{cutoff}.xml", ANALYZE.format(out=theirs.name, local=local, **fill)
                            .replace('name="B"><bodies', f'name="B"><on>{not local}</on><bodies')) for local in (False, True)]
        dynamics = write_setup(folder / f"id{cutoff}.xml", DYNAMICS.format(out=theirs.name, loads="", **fill))
        for setup in both:
            if not opensim.AnalyzeTool(str(setup)).run():
                sys.exit("OpenSim's AnalyzeTool failed")
        if not opensim.InverseDynamicsTool(str(dynamics)).run():
            sys.exit("OpenSim's InverseDynamicsTool failed")
        ours(both[0], mine)
        ours(both[1], folder / f"local{cutoff}")
        ours(dynamics, folder / f"tau{cutoff}")
        what = f"{name}, {'no low-pass' if cutoff < 0 else f'low-pass of {cutoff} Hz'}"
        tables = ["judge_K_q.sto", "judge_K_u.sto", "judge_B_pos_global.sto", "judge_B_vel_global.sto", "judge_P_point_pos.sto",
                  "judge_P_point_vel.sto"]
        good &= compare(f"{what}: coordinates, bodies, a point", tables, bound, theirs, mine)
        good &= compare(f"{what}: bodies in their own axes", ["judge_L_pos_global.sto", "judge_L_vel_bodyLocal.sto"], bound, theirs,
                        folder / f"local{cutoff}")
        good &= compare_torques(f"{what}: torques", bound, theirs / "tau.sto", folder / f"tau{cutoff}/tau.sto", mine / "judge_K_u.sto")
        if cutoff < 0:
            good &= acceleration_rows(name, theirs, mine)
    return good


def check_forces(opensim, scratch):
    """gait2354 with forces under both feet."""
    folder = scratch / "forces"
    folder.mkdir()
    os.chdir(folder)
    opensim.Model(str(DATA / CASES["gait2354"][0])).printToXML(str(folder / "model.osim"))
    write_motion(opensim, folder / "model.osim", read_table(DATA / CASES["gait2354"][1]), folder)
    feet.write_table(folder / "grf.mot", feet.make_forces([i / RATE_HZ for i in range(FRAMES)]), "no")
    (folder / "loads.xml").write_text(feet.LOADS.format("".join(feet.FORCE.format(foot) for foot in "rl")))
    setup = write_setup(folder / "id.xml", DYNAMICS.format(
        out="theirs", model="model.osim", cutoff=-1, loads="<external_loads_file>loads.xml</external_loads_file>"))
    if not opensim.InverseDynamicsTool(str(setup)).run():
        sys.exit("OpenSim's InverseDynamicsTool failed")
    ours(setup, folder / "ours")
    return compare_torques("gait2354, forces under both feet: torques", ALIKE, folder / "theirs/tau.sto", folder / "ours/tau.sto",
                           folder / "theirs/tau.sto")


def main():
    if not DATA.is_dir():
        print("SKIP | kinemark analyze beside OpenSim's tools | as theirs | no recordings")
        return 0
    import opensim

    opensim.Logger.setLevelString("Off")
    with tempfile.TemporaryDirectory() as scratch:
        good = [check_case(opensim, name, Path(scratch)) for name in CASES]
        good.append(check_forces(opensim, Path(scratch)))
        os.chdir("/")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
