# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Inverse kinematics of kinemark and of OpenSim on the same files: solve time, cost reached, angle differences.

Both costs come from the same few lines of numpy, with the marker positions of OpenSim's own model for both motions.
Needs the Python packages of tools/setup --oracles.
"""

import dataclasses
import json
import os
import statistics
import subprocess
import time
from pathlib import Path

import numpy as np
import opensim as osim

osim.Logger.setLevelString("error")
osim.Logger.removeFileSink()  # else opensim.log appears in whatever folder we are in

EQUAL_COST = 1e-9  # relative; two optima closer than this differ by the rounding of positions only
KINEMARK_RUNS = 15  # one takes milliseconds


@dataclasses.dataclass(frozen=True)
class Case:
    name: str
    model: Path
    markers: Path
    setup: Path  # OpenSim's; weights, tasks and accuracy come from it
    range_s: tuple[float, float] | None = None  # None: that of the setup file
    accuracies: tuple[float, ...] = (1e-9,)  # of OpenSim, one run each, after the setup file's own
    setup_runs: int = 3  # of OpenSim at the accuracy of the setup file


def cases(data):
    """The recordings that are compared; `data` is the folder of the real recordings."""
    gait, hamner, run = data / "opensim-gait2354", data / "opensim-hamner-fullbody", data / "bmc-rajagopal-run"
    gait_files = (gait / "subject01_simbody.osim", gait / "subject01_walk1.trc", gait / "subject01_Setup_IK.xml")
    return {
        "gait2354": Case("gait2354, whole trial", *gait_files, (0.0, 2.5), (1e-9, 1e-12)),
        "gait2354_setup": Case("gait2354, setup's 0.4-1.6 s", *gait_files),
        "hamner": Case("Hamner full body", hamner / "subject02_registered.osim", hamner / "subject02_running.trc",
                       hamner / "Setup_IK.xml", accuracies=(), setup_runs=1),
        "rajagopal": Case("Rajagopal run", run / "Scale" / "Rajagopal2015_scaled.osim",
                          run / "ExpData" / "motion_capture_run.trc", run / "IK" / "IK_setup.xml"),
    }


@dataclasses.dataclass
class Motion:
    """What one program answered. Rotations in rad, translations in m."""

    program: str
    time_s: np.ndarray  # F
    coordinates: list[str]  # n
    q: np.ndarray  # F x n
    solve_s: list[float]  # one per run: the solve alone, no loading, no writing
    cost: float = np.nan  # m^2, summed over frames

    @property
    def frames_per_s(self):
        return len(self.time_s) / statistics.median(self.solve_s)


class OpenSimProblem:
    """A case as OpenSim reads it: its model, tasks and markers."""

    def __init__(self, case):
        self.tool = osim.InverseKinematicsTool(str(case.setup), False)
        self.accuracy = self.tool.get_accuracy()
        self.model_path, self.markers_path = str(case.model), str(case.markers)
        self.model = osim.Model(self.model_path)
        self.state = self.model.initSystem()
        markers = osim.MarkersReference(self.markers_path, osim.SetMarkerWeights())
        table = markers.getMarkerTable()
        flat = table.flatten()  # with a name: Python must not free it while its matrix is read
        self.x_m = flat.getMatrix().to_numpy().reshape(table.getNumRows(), -1, 3).copy()
        names = list(table.getColumnLabels())
        time_s = np.array(table.getIndependentColumn())
        first, last = case.range_s or (self.tool.getStartTime(), self.tool.getEndTime())
        slack = 0.1 * (time_s[1] - time_s[0])  # times are written with few digits
        inside = (time_s >= first - slack) & (time_s <= last + slack)
        self.time_s, self.x_m = time_s[inside], self.x_m[inside]
        # A marker that lies at the origin in every frame was never seen, though OpenSim takes it as data.
        never = np.all(np.isnan(self.x_m) | (self.x_m == 0.0), axis=(0, 2))
        seen = {name for name, nothing in zip(names, never) if not nothing}
        self.read_tasks(seen)
        self.x_m = self.x_m[:, [names.index(name) for name in self.weights]]

    def read_tasks(self, seen):
        """weights: {marker: weight} of what takes part; coordinate_tasks: {coordinate: (weight, value)}."""
        known = {marker.getName() for marker in self.model.getMarkerSet()}
        self.weights, self.coordinate_tasks = {}, {}
        tasks = self.tool.getIKTaskSet()
        for task in (tasks.get(i) for i in range(tasks.getSize())):
            name, weight = task.getName(), task.getWeight()
            if not task.getApply() or weight == 0.0:
                continue
            if task.getConcreteClassName() == "IKMarkerTask":
                if name in seen & known:
                    self.weights[name] = weight
                continue
            coordinate_task = osim.IKCoordinateTask.safeDownCast(task)
            if coordinate_task.getValueType() == osim.IKCoordinateTask.FromFile:
                raise NotImplementedError(f"{name}: coordinate values from a file")
            default = self.model.getCoordinateSet().get(name).getDefaultValue()
            manual = coordinate_task.getValueType() == osim.IKCoordinateTask.ManualValue
            self.coordinate_tasks[name] = (weight, coordinate_task.getValue() if manual else default)

    def references(self):
        weights = osim.SetMarkerWeights()
        for name, weight in self.weights.items():
            weights.cloneAndAppend(osim.MarkerWeight(name, weight))
        markers = osim.MarkersReference()
        markers.set_default_weight(0.0)
        markers.initializeFromMarkersFile(self.markers_path, weights)
        coordinates = osim.SimTKArrayCoordinateReference()
        for name, (weight, value) in self.coordinate_tasks.items():
            reference = osim.CoordinateReference(name, osim.Constant(value))
            reference.setWeight(weight)
            coordinates.push_back(reference)
        return markers, coordinates

    def solve(self, accuracy, runs):
        """OpenSim's solver, frame by frame as its tool does it, from the model's default pose."""
        solve_s = []
        for _ in range(runs):
            model = osim.Model(self.model_path)
            state = model.initSystem()
            markers, references = self.references()
            solver = osim.InverseKinematicsSolver(model, markers, references, self.tool.get_constraint_weight())
            solver.setAccuracy(accuracy)
            coordinates = [model.getCoordinateSet().get(i) for i in range(model.getNumCoordinates())]
            q = np.empty((len(self.time_s), len(coordinates)))
            seconds = 0.0
            for frame, t in enumerate(self.time_s):
                state.setTime(float(t))
                start = time.perf_counter()
                if frame == 0:
                    solver.assemble(state)
                solver.track(state)
                seconds += time.perf_counter() - start
                q[frame] = [c.getValue(state) for c in coordinates]
            solve_s.append(seconds)
        return Motion(f"OpenSim at {accuracy:g}", self.time_s, [c.getName() for c in coordinates], q, solve_s)

    def marker_positions(self, motion):
        """F x M x 3, m: where OpenSim's model has its markers in the given pose, taken exactly as given."""
        coordinates = [self.model.getCoordinateSet().get(name) for name in motion.coordinates]
        for coordinate in coordinates:
            coordinate.setLocked(self.state, False)
            coordinate.setClamped(self.state, False)
        markers = [self.model.getMarkerSet().get(name) for name in self.weights]
        positions = np.empty((len(motion.q), len(markers), 3))
        for frame, q in enumerate(motion.q):
            for coordinate, value in zip(coordinates, q):
                coordinate.setValue(self.state, float(value), False)
            self.model.realizePosition(self.state)
            positions[frame] = [marker.getLocationInGround(self.state).to_numpy() for marker in markers]
        return positions

    def cost(self, motion):
        """Sum over frames of sum(w |r|^2) / sum(w) + sum(W (q - q0)^2), over the markers seen in each frame, m^2."""
        squares = np.sum((self.x_m - self.marker_positions(motion)) ** 2, axis=2)
        w = np.where(np.isnan(squares), 0.0, np.array(list(self.weights.values())))
        cost = np.sum(np.sum(w * np.nan_to_num(squares), axis=1) / np.sum(w, axis=1))
        for name, (weight, value) in self.coordinate_tasks.items():
            cost += weight * np.sum((motion.q[:, motion.coordinates.index(name)] - value) ** 2)
        return float(cost)


def read_motion(path, report):
    """(times, names, q) of a .mot file in degrees; the report says which coordinates are rotations."""
    head, body = path.read_text(encoding="utf-8").split("endheader\n", 1)
    if "inDegrees=yes" not in head:
        raise ValueError(f"{path}: expected inDegrees=yes")
    names, *rows = body.splitlines()
    table = np.array([[float(cell) for cell in row.split()] for row in rows])
    units = {c["name"]: np.pi / 180.0 if c["unit"] == "deg" else 1.0 for c in report["coordinates"]}
    names = names.split()[1:]
    return table[:, 0], names, table[:, 1:] * [units[name] for name in names], [units[name] != 1.0 for name in names]


def solve_by_kinemark(program, case, folder, runs):
    """(Motion, which coordinates are rotations). Every sample is kept as OpenSim keeps it: both solve one problem."""
    output = folder / "Q.mot"
    command = [program, "ik", "--setup", case.setup, "--model", case.model, "--markers", case.markers, "--output", output,
               "--threads", 1, "--no-error-bars", "--doubtful", "keep", "--force", "--quiet"]
    if case.range_s:
        command += ["--start", case.range_s[0], "--end", case.range_s[1]]
    solve_s = []
    for _ in range(runs):
        subprocess.run([str(part) for part in command], check=True, cwd=folder, stderr=subprocess.DEVNULL)
        report = json.loads((folder / "Q_report.json").read_text(encoding="utf-8"))
        solve_s.append(report["solve_s"])
    time_s, names, q, is_rotation = read_motion(output, report)
    return Motion("kinemark", time_s, names, q, solve_s), is_rotation


def largest_angle_deg(ours, theirs, is_rotation):
    """(degrees, "coordinate at time") of the largest difference."""
    order = [theirs.coordinates.index(name) for name in ours.coordinates]
    off = np.degrees(np.abs(ours.q - theirs.q[:, order])) * is_rotation
    frame, column = np.unravel_index(np.argmax(off), off.shape)
    return float(off[frame, column]), f"{ours.coordinates[column]} at {ours.time_s[frame]:.3f} s"


def compare(program, case, folder):
    """[{program, frames, frames_per_s, ...}]: kinemark, OpenSim as its setup asks, and OpenSim at case.accuracies.

    kinemark runs before, between and after OpenSim's runs, so that both meet the same load of the machine.
    """
    problem = OpenSimProblem(case)
    solved, solve_s = [], []
    plan = [(problem.accuracy, case.setup_runs), *((accuracy, 1) for accuracy in case.accuracies)]
    for accuracy, runs in plan:
        ours, is_rotation = solve_by_kinemark(program, case, folder, KINEMARK_RUNS // (len(plan) + 1))
        solve_s += ours.solve_s
        solved.append(problem.solve(accuracy, runs))
    ours, is_rotation = solve_by_kinemark(program, case, folder, KINEMARK_RUNS - len(solve_s))
    ours.solve_s = solve_s + ours.solve_s
    if len(ours.time_s) != len(problem.time_s) or not np.allclose(ours.time_s, problem.time_s, atol=1e-3):
        raise ValueError(f"{case.name}: kinemark solved {len(ours.time_s)} frames, OpenSim {len(problem.time_s)}")
    ours.cost = problem.cost(ours)
    results = [{"case": case.name, "program": ours.program, "frames": len(ours.time_s), "runs": len(ours.solve_s),
                "fastest_frames_per_s": len(ours.time_s) / min(ours.solve_s), "load": os.getloadavg()[0],
                "markers": len(problem.weights), "coordinates": len(ours.coordinates),
                "frames_per_s": ours.frames_per_s, "cost_m2": ours.cost}]
    for theirs in solved:
        theirs.cost = problem.cost(theirs)
        angle_deg, where = largest_angle_deg(ours, theirs, is_rotation)
        results.append({**results[0], "program": theirs.program, "runs": len(theirs.solve_s),
                        "fastest_frames_per_s": len(theirs.time_s) / min(theirs.solve_s),
                        "frames_per_s": theirs.frames_per_s, "cost_m2": theirs.cost,
                        "kinemark_speed_ratio": ours.frames_per_s / theirs.frames_per_s,
                        "kinemark_cost_ratio": ours.cost / theirs.cost,
                        "largest_angle_deg": angle_deg, "largest_angle_at": where})
    return results


def is_cost_bound_met(theirs):
    return theirs["kinemark_cost_ratio"] <= 1.0 + EQUAL_COST


def speed_row(results, least_per_s=10_000, least_ratio=100):
    """(passed, check, asked, measured): fast, and faster than OpenSim at equal or lower cost, in this run."""
    ours, theirs = results[:2]
    ratio = theirs["kinemark_speed_ratio"]
    passed = ours["frames_per_s"] >= least_per_s and ratio >= least_ratio and is_cost_bound_met(theirs)
    return (passed, f"IK speed, one thread, solve only, {ours['case']}",
            f">= {least_per_s:,} frames/s and >= {least_ratio} x OpenSim's at equal or lower cost in the same run",
            f"{ours['frames_per_s']:,.0f} frames/s (median of {ours['runs']}; fastest "
            f"{ours['fastest_frames_per_s']:,.0f}; load {ours['load']:.1f} on {os.cpu_count()} processors), {ratio:.0f} x {theirs['program']}, "
            f"cost {theirs['kinemark_cost_ratio']:.7f} of its")


def converged_row(results, most_deg=1e-4):
    theirs = results[-1]
    accuracy = theirs["program"].removeprefix("OpenSim at ")
    return (theirs["largest_angle_deg"] <= most_deg and is_cost_bound_met(theirs),
            f"OpenSim converged (accuracy {accuracy}) and kinemark, {theirs['case']}",
            f"within {most_deg:g} deg, cost not higher",
            f"{theirs['largest_angle_deg']:.1e} deg ({theirs['largest_angle_at']}); at its setup's accuracy "
            f"{results[1]['largest_angle_deg']:.2f} deg")


def cost_row(results):
    theirs = results[1:]
    return (all(is_cost_bound_met(one) for one in theirs), f"weighted cost, {results[0]['case']}", "<= OpenSim's",
            ", ".join(f"{one['kinemark_cost_ratio']:.7f} of {one['program']}'s" for one in theirs))
