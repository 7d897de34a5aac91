# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""For test_every_command.py: of every command that does not measure a command line, and of each of its options a value that changes
what is found or written, or is refused by name."""

import re

EVERYWHERE = {"--help", "--threads", "--seed", "--force", "--quiet", "--json", "--config", "--save-config"}


def options_in(shown):
    """The options that a help shows, but those that every command takes."""
    return set(re.findall(r"^  (?:-\w,\s*)?(--[a-z-]+)", shown, re.MULTILINE)) - EVERYWHERE


RECORDING = {
    "--rate": 50, "--unit": "mm", "--edits": "absent.jsonl", "--select": "L*", "--drop": "LKNE", "--rename": "LKNE=LEFT", "--doubtful": "perhaps",
    "--frames": "6-20", "--start": 0.05, "--end": 0.2, "--up": "z", "--rotate": "x 90",
}
OF_BODY = {**RECORDING, "--select": "?ASI,?PSI,?KNE", "--up": "-y"}
OF_ARM = {**RECORDING, "--select": "absent*", "--drop": "s0m3", "--rename": "absent=LEFT"}
SEVERAL = {"--jobs": 2, "--keep-going": None}
IMAGES = {"--rig": "absent.toml", "--images": "A=absent.csv", "--image-noise": 3, "--min-likelihood": 0.2, "--person": 2}
MOTION = {**OF_BODY, **SEVERAL, **IMAGES, "--model": "absent.osim", "--markers": "absent.trc", "--forces": "absent.mot",
          "--geometry": "absent", "--output": "other.mot", "--no-error-bars": None, "--nwb": None, "--report": "page.html", "--weight": "LASI=0",
          "--noise": 3, "--no-limits": None, "--max-rms": 0.01, "--max-offset": 1e-6}
CURVES = {"--output": "o.csv", "--group": "when", "--subject": "who", "--curve": "when,who", "--at": "at", "--value": "other", "--where": "when=x"}
BY = ["--curve", "who,when"]
LIMB = {"--out": "other", "--noise": 3, "--missing": 0.3, "--upsample": 4, "--interpolation": "cubic", "--rate": 50}
ON_BODY = ["--model", "body.osim", "--markers", "body.trc", "--output"]
ARM = ["arm.trc", "--segments", "arm.toml", "--output"]
RIG = ["--out", "o", "--duration", 0.05]
COUNTS = ["recording.mcap", "--rig", "rig.toml", "--output", "o.csv"]
TREE = ["grid_A.mcap", "grid_B.mcap", "tree_poses.mcap", "--nominal", "rig.toml", "--output", "o.toml"]

# Of a command: words, and the value of each option.
TRIED = {
    "info": (["legs.trc"], RECORDING),
    "validate": (["legs.trc"], {"--model": "absent.osim"}),
    "convert": (["legs.trc", "o.csv"],
                {**RECORDING, **SEVERAL, "--skeleton": "absent.asf", "--merge": None, "--resample": 60, "--model": "absent.osim",
                 "--ndx-pose": None, "--orientations": None, "--to": "trc"}),
    "clean": (["legs.trc", "o.csv"],
              {**RECORDING, **SEVERAL, "--gaps": "linear", "--max-gap": 0.011, "--max-gap-sd": 0.01, "--filter": "gcv", "--order": 4,
               "--cutoff": 7, "--cutoff-rule": "challis", "--uncorrected-cutoff": None, "--noise": 9, "--upsampled": "missing",
               "--without-unfiltered": None, "--keep-exchanges": None, "--derivatives": None, "--report": "page.html", "--to": "trc"}),
    "joints": ([*ARM, "o.csv"],
               {**OF_ARM, **SEVERAL, "--to": "trc", "--segments": "absent.toml", "--keep-upsampled": None, "--output": "other.csv",
                "--report": "page.html", "--figures": "arm.svg", "--method": "score", "--sides": "parent", "--kind": "hinge", "--noise": 4,
                "--no-continuity": None, "--soft-tissue": None}),
    "scale": ([*ON_BODY, "o.osim", "--max-frames", 20],
              {**OF_BODY, "--model": "absent.osim", "--static": "body.trc", "--setup": "absent.xml", "--markers": "absent.trc",
               "--joints": "absent.json", "--output": "other.osim", "--report": "page.html", "--mass": 60, "--dempster": None,
               "--clavicles": None, "--symmetric": None, "--size-prior": 1, "--place-prior": 1, "--joint-prior": 3, "--noise": 8,
               "--no-soft-tissue": None, "--max-frames": 10, "--max-rms": 0.001}),
    "ik": ([*ON_BODY, "o.mot"],
           {**MOTION, "--setup": "absent.xml", "--tasks": "absent.xml", "--locations": None, "--coordinate-weight": "pelvis_tilt=500",
            "--loss": "cauchy", "--estimator": "smoother", "--torques": None, "--loss-scale": 0.5, "--orientations": "absent.sto",
            "--calibration": "absent.sto", "--sensor": "a=b", "--sensors-up": "z", "--heading": "a:x", "--orientation-noise": 2, "--max-orientation-rms": 1}),
    "track": ([*ON_BODY, "o.mot"],
              {**MOTION, "--level": "LASI,RASI", "--lock": "neck_bending", "--rest": "neck_bending=0.2", "--no-lock": None, "--omega": 50,
               "--step": 1, "--damping": 0.5, "--posture": "10,5", "--cutoff": 3, "--settle": None, "--adapt": None, "--strict": None, "--level-bound": 5, "--propose-levels": None, "--accuracy": "9deg",
               "--no-feed-forward": None}),
    "report": (["legs.trc", "--output", "o.html"],
               {**RECORDING, "--output": "other.html", "--skeleton": "absent.asf", "--geometry": "absent"}),
    "edit": (["legs.trc", "--cut", "LKNE"],
             {"--edits": "other.jsonl", "--rate": 50, "--unit": "mm", "--relabel": ["LKNE", "LEFT"], "--swap": ["LKNE", "RKNE"], "--cut": "RKNE",
              "--fill": "LKNE", "--unfill": "LKNE", "--crop": None, "--mark": "step", "--move": "step", "--delete": "step",
              "--region": "turn", "--exchanges": None, "--undo": 1, "--redo": 1, "--list": None, "--from": 10, "--to": 20,
              "--frames": "10-20", "--at": "0.2s", "--context": "Left", "--method": "linear", "--author": "me"}),
    "groups spm": (["curves.csv", *BY, "--group", "when"],
                   {**CURVES, "--group": "absent", "--paired": None, "--alpha": 0.5, "--one-sided": None, "--arrangements": 9}),
    "groups band": (["curves.csv", *BY], {**CURVES, "--level": 0.5}),
    "groups norm": (["norm.csv", "curves.csv", *BY], {**CURVES, "--norm-where": "absent=a"}),
    "groups retest": (["measures.csv"], {"--output": "o.csv", "--subject": "absent", "--session": "absent", "--value": "absent", "--sd": "absent",
                                         "--by": "absent", "--where": "measure=absent", "--level": 0.5}),
    "calibrate": (TREE, {"--nominal": "absent.toml", "--output": "other.toml", "--report": "page.html", "--align": None, "--method": "grid-lut",
                         "--sides": [0.1, 0.1, 0.1], "--frames-per-pose": 7, "--warp-degree": 4, "--no-crosstalk": None, "--no-escalate": None}),
    "reconstruct": (COUNTS, {"--rig": "absent.toml", "--output": "other.csv", "--report": "page.html", "--method": "frames", "--flicker": "dark-slot",
                             "--order": 4, "--half-gain": 5, "--longest-gap": 0.001, "--dim": 0.999, "--calibrated-offsets": None}),
    "simulate subject": (["--out", "o", "--duration", 0.2],
                         {"--out": "other", "--model": "absent.osim", "--duration": 0.1, "--rate": 50, "--noise": 3, "--soft-tissue": 1,
                          "--soft-tissue-common": 0.9, "--dropout-random": 0.2, "--dropout-sight": 0.2}),
    "simulate arm": (["--out", "o", "--frames", 20],
                     {**LIMB, "--frames": 10, "--segments": "100,100", "--markers": 4, "--stagger": 10, "--planar": None, "--pose-correlated": None}),
    "simulate macaque": (["--out", "o", "--duration", 2],
                         {**LIMB, "--duration": 1, "--leds": 5, "--tip": None, "--skin": 3, "--all-seen": None, "--hard": None, "--obstacles": None,
                          "--units": 2, "--trials": 2, "--lfp": None}),
    "simulate rig": (RIG, {"--out": "other", "--pose": 3, "--turned": 20, "--leds": 2, "--glint": None, "--markers": "absent.trc",
                           "--marker": "RKNE", "--z-up": None, "--keep-place": None, "--rate": 50, "--highest-rate": None, "--duration": 0.1,
                           "--intensity": 0.5, "--occlude": "all:A:1-3", "--dark-slot": None, "--no-noise": None, "--detector": "pin-cushion",
                           "--imperfection": 3, "--misalignment": 3, "--crosstalk": 0.1, "--ripple": 0.1, "--bits": 10, "--conversion": 64, "--grid": None, "--tree-poses": None,
                           "--scan": None}),
    "acquire": (["sim:rig?fast", "--output", "o.mcap", "--frames", 60],
                {"--output": "other.mcap", "--leds": 3, "--rate": 50, "--intensity": 0.5, "--duration": 0.1, "--frames": 30, "--trigger": "digital",
                 "--sync": "often", "--subject": "who", "--trial": "what", "--list": None, "--rig": "absent.toml", "--session": "day", "--plan": "plan.svg", "--check": None}),
    "recover": (["cut.mcap", "o.mcap"], {}),
    "run": (["study.toml", "--dry-run"], {"--subject": "absent", "--jobs": 2, "--keep-going": None, "--dry-run": None}),
    "help": (["gait"], {"--man": None, "--man-pages": "absent", "--formats": None}),
    "completion": (["bash"], {}),
}

# What an option needs beside it: without these words it is refused.
SCENE = {"tree": ["--pose"], "wheel": ["--turned", "--leds"]}
WITH = {
    ("clean", "--max-gap"): ["--gaps", "linear"], ("clean", "--max-gap-sd"): ["--gaps", "auto"],
    ("clean", "--cutoff-rule"): ["--filter", "butterworth"], ("clean", "--uncorrected-cutoff"): ["--filter", "butterworth"],
    ("joints", "--sides"): ["--method", "score"], ("ik", "--loss-scale"): ["--loss", "huber"],
    ("ik", "--geometry"): ["--report", "page.html"], ("track", "--geometry"): ["--report", "page.html"],
    ("track", "--strict"): ["--level", "LASI,RASI,LPSI,RPSI", "--level", "*"],
    ("track", "--level-bound"): ["--level", "LASI,RASI,LPSI,RPSI", "--level", "*", "--strict"],
    ("simulate subject", "--soft-tissue-common"): ["--soft-tissue", 1],
    ("simulate arm", "--interpolation"): ["--upsample", 4], ("simulate macaque", "--interpolation"): ["--upsample", 4],
    ("simulate arm", "--planar"): ["--stagger", 10], ("simulate arm", "--pose-correlated"): ["--missing", 0.2],
    **{("simulate rig", option): [scene] for scene, options in SCENE.items() for option in options},
    **{("simulate rig", option): ["markers", "--markers", "legs.trc", "--marker", "LKNE"] for option in ("--z-up", "--keep-place")},
}

# Other words for an option that these do not show.
FOLDER = ["legs.trc", "body.trc", "folder", "--to", "csv"]
INSTEAD = {
    ("convert", "--merge"): ["legs.trc", "body.trc", "o.csv", "--to", "csv"], ("convert", "--to"): FOLDER, ("clean", "--to"): FOLDER,
    ("joints", "--to"): ["arm.trc", "leg.trc", "--output", "folder"], ("joints", "--up"): [*ARM, "o.c3d"],
    ("joints", "--keep-upsampled"): ["fast.trc", "--segments", "arm.toml", "--output", "o.csv"],
    ("clean", "--up"): ["legs.trc", "o.c3d"], ("clean", "--upsampled"): ["fast.trc", "o.csv"],
    ("clean", "--keep-exchanges"): ["swapped.trc", "o.csv"],
    ("simulate rig", "--glint"): ["wheel", "--out", "o", "--duration", 2.2],
    ("groups spm", "--paired"): ["curves.csv", "--subject", "who", "--group", "when"],
    ("calibrate", "--no-escalate"): [*TREE, "--warp-degree", 2],
}

# The bits are the same, whatever it is; for one recording it is refused. Skin that slides is not there to be found.
SAME = {*((command, option) for command in ("convert", "clean", "joints", "ik", "track", "run") for option in SEVERAL), ("run", "--dry-run"),
        ("edit", "--cut"), ("scale", "--no-soft-tissue")}

# What is not for the others: words, the option that is refused, and what is said of it.
REFUSED = [
    ("track -m body.osim -t body.trc -o o.mot", "--strict", "is for several levels; --level is given 0 times"),
    ("track -m body.osim -t body.trc -o o.mot", "--level-bound=5", "is for strict levels; --strict is not given"),
    *((f"simulate arm -o o --stagger {zero}", "--planar", f"is for markers beside the bone; --stagger is {zero}") for zero in ("0", "0.0", "0e3")),
    *((f"clean legs.trc o.csv --filter {name}", option, "is for") for name in ("none", "kalman", "gcv", "savgol", "classic")
      for option in ("--uncorrected-cutoff", "--cutoff-rule=challis")),
    ("clean legs.trc o.csv --filter none", "--cutoff=6", "is for positions that are smoothed; --filter is none"),
    ("clean legs.trc o.csv --filter none", "--without-unfiltered", "is for positions that are smoothed"),
    ("clean legs.trc o.csv --filter classic", "--order=4", "is for filters that have a choice of it"),
    ("clean legs.trc o.csv --filter butterworth --cutoff 6", "--cutoff-rule=challis", "is for a cut-off that is found"),
    *((f"joints arm.trc -o o.csv --method {name}", "--no-continuity", "is for the articulated method") for name in ("score", "gamage")),
    ("joints arm.trc -o o.csv --method score", "--soft-tissue", "is for the articulated method; --method is score"),
    ("joints arm.trc -o o.csv --method cylinder", "--kind=ball", "is for articulated, score"),
    ("joints arm.trc -o o.csv --method constant-distance", "--sides=child", "is for score"),
    *((f"{command} -m body.osim -t body.trc -o o.mot", option, "is for images; --images is not given") for command in ("ik", "track")
      for option in ("--image-noise=3", "--min-likelihood=0.2", "--person=2")),
    ("ik -m body.osim -t body.trc -o o.mot --estimator smoother", "--loss=huber", "is for least squares"),
    ("ik -m body.osim -t body.trc -o o.mot --estimator smoother", "--coordinate-weight=pelvis_tilt=1", "is for least squares"),
    ("scale -m body.osim --static body.trc -o o.osim", "--joint-prior=3", "is for functional joint centres; --joints is not given"),
    ("scale -m body.osim --static body.trc -o o.osim", "--start=0.1", "is for the motion"),
    *((f"{command}{several} {option}", option.split("=")[0], "is for several recordings") for option in ("--jobs=2", "--keep-going")
      for command, several in (("convert legs.trc o.csv", ""), ("clean legs.trc o.csv", ""), ("joints arm.trc -o o.csv", ""),
                               ("ik -m body.osim -t body.trc -o o.mot", ""), ("track -m body.osim -t body.trc -o o.mot", ""))),
    ("convert legs.trc o.csv", "--merge", "is for several files"),
    ("convert legs.trc body.trc o.csv --merge", "--keep-going", "is for recordings that stay several"),
    ("info recording.mcap", "--select=A", "is no recording of markers"),
    ("report legs.trc -o o.html", "--skeleton=absent.asf", "is for .amc"),
    ("edit legs.trc --list", "--from=3", "is for --relabel, --swap"), ("edit legs.trc --list", "--author=me", "this is --list"),
    ("edit legs.trc --mark a --at 3", "--from=3", "is for"), ("edit legs.trc --cut LKNE", "--context=Left", "is for --mark, --move, --delete"),
    ("edit legs.trc --exchanges", "--to=3", "this is --exchanges"), ("edit legs.trc --undo 1", "--at=3", "this is --undo"),
    ("calibrate grid_A.mcap grid_B.mcap --nominal rig.toml --method grid-lut -o o.toml", "--warp-degree=4", "is for the methods bundle and scan"),
    ("calibrate grid_A.mcap grid_B.mcap --nominal rig.toml --method grid-lut", "--align", "is for the methods bundle and scan"),
    ("calibrate scan.mcap --nominal rig.toml --method scan -o o.toml", "--frames-per-pose=5", "is for the tree"),
    ("calibrate tree_poses.mcap --nominal rig.toml --align", "--no-crosstalk", "is for a rig that is calibrated; --align is given too"),
    ("reconstruct recording.mcap --rig rig.toml -o o.csv --method classic", "--calibrated-offsets", "is for the methods smoother and frames"),
    *((f"reconstruct recording.mcap --rig rig.toml -o o.csv --method {name}", option, "is for the method smoother")
      for name in ("frames", "classic") for option in ("--order=4", "--half-gain=5", "--longest-gap=0.1", "--flicker=ignore")),
    *((f"simulate rig {scene} -o o", option, "is for the scene") for scene in ("sign", "tree")
      for option in ("--turned=3", "--leds=2", "--glint", "--z-up", "--keep-place", "--marker=A", "--markers=legs.trc")),
    ("simulate rig wheel -o o", "--pose=3", "is for the scene tree; scene is wheel"),
    ("simulate rig -o o --highest-rate", "--rate=50", "--highest-rate is given too"),
    *((command, "--level=0.95", "is for the measures of a gait report; --report is not given")
      for command in ("segments legs.trc --definition pig", "analyze legs.trc --segments pig")),
    ("analyze q.mot -m body.osim --no-error-bars", "--refits=20", "is for intervals; --no-error-bars is given too"),
    *((f"{words}", option, "is no time; need a number of seconds") for option in ("--start=inf", "--end=-inf")
      for words in ("measure legs.trc", "clean legs.trc o.csv", "dynamics q.mot -m body.osim")),
    ("measure legs.trc --refits 0", "--level=0.8", "is for intervals; --refits is 0"),
    ("gait legs.trc --refits 0", "--noise=2", "is for intervals"),
    ("dynamics q.mot -m body.osim --no-error-bars", "--refits=20", "is for intervals"),
    ("study poizner --seeds 1-2", "--seed=3", "--seeds is given too"), ("study taichi", "--rate=179", "is for a recording"),
    ("study taichi --data absent.v3d", "--seeds=3", "is for simulated subjects"),
    *((f"study {name}", "--force", "is for a page that is written") for name in ("poizner", "macaque", "taichi")),
    *(("serve sim:walk --no-open", option, "is for files; sim:walk is a live source") for option in ("--geometry=.", "--tasks=a.xml", "--weight=A=2")),
    ("serve sim:rig --no-open", "--model=arm.osim", "sim:rig is a device that gives counts"),
    *(("serve sim:rig --no-open", option, "for markers and body models") for option in ("--geometry=.", "--tasks=a.xml", "--weight=A=2", "--level=A", "--strict", "--omega=50")),
    ("serve legs.trc --no-open", "--rig=rig.toml", "--rig is for a device"), ("serve sim:walk --no-open", "--rig=rig.toml", "--rig is for a device"),
    ("serve legs.trc --no-open", "--record=a.mcap", "is for a live source"), ("serve legs.trc --no-open", "--json", "its result is no JSON"),
    *(("serve legs.trc --no-open", option, "are for a live source") for option in ("--level=A", "--strict", "--omega=50")),
    *(("serve replay:legs.trc --no-open", option, "need the body model that follows the source") for option in ("--level=A", "--omega=50")),
    ("serve sim:walk --no-open", "--strict", "is for several levels; --level is given 0 times"),
    ("serve legs.trc --no-open", "--key=a.pem", "belong together"), ("serve legs.trc --no-open", "--certificate=a.pem", "belong together"),
    ("help --formats", "--man", "is for commands"), ("help gait --man-pages .", "--man", "is for one command"),
    ("help gait --formats", "COMMAND", "is for commands"), ("help gait", "--json", "its result is no JSON"), ("help gait", "--force", "is for pages"),
    ("completion bash", "--json", "its result is no JSON"), ("completion bash", "--force", "it writes no file"),
    ("validate legs.trc", "--force", "it writes no file"),
    *((f"{words}", "--seed=3", "nothing in it is random") for words in ("validate legs.trc", "recover cut.mcap o.mcap", "completion zsh",
                                                                      "groups band curves.csv", "groups retest measures.csv", "help")),
    *((f"groups {words}", "--force", "is for a table that is written") for words in ("band curves.csv", "spm curves.csv", "retest measures.csv")),
]
