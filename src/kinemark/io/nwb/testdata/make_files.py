# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the HDF5 files of this folder, with pandas 3.1.1 and PyTables 3.11.1, and sleap-io 0.9.5.

Everywhere: x = 100 person + 10 point + frame, y = x + 0.5 in px, a score of 0.9, but 0.3 of the second point in frame 1;
nothing of the first point in frame 2. Four frames.
"""

import numpy as np
import pandas as pd
import sleap_io

POINTS, FRAMES = ["wrist", "ellbogen_ü"], 4
SMALL = {"complevel": 9, "index": False}


def values(people):
    person, frame, point = np.meshgrid(np.arange(people), np.arange(FRAMES), np.arange(2), indexing="ij")
    x = 100.0 * person + 10.0 * point + frame
    score = np.where((point == 1) & (frame == 1), 0.3, 0.9)
    out = np.stack([x, x + 0.5, score], axis=-1)  # person, frame, point, (x, y, score)
    out[:, 2, 0] = np.nan
    return out


def deeplabcut(name, people, rows_are=None, **how):
    levels = [["net"], *([["m1", "m2"][:people]] if people > 1 else []), POINTS, ["x", "y", "likelihood"]]
    names = ["scorer", *(["individuals"] if people > 1 else []), "bodyparts", "coords"]
    rows = values(people).transpose(1, 0, 2, 3).reshape(FRAMES, -1)
    table = pd.DataFrame(rows, columns=pd.MultiIndex.from_product(levels, names=names), index=rows_are)
    table.to_hdf(name, key="df_with_missing", mode="w", **how)


def sleap(people):
    skeleton = sleap_io.Skeleton(nodes=POINTS)
    video = sleap_io.Video(filename="video.mp4", open_backend=False)
    tracks = [sleap_io.Track(f"track_{p}") for p in range(people)]
    all_values = values(people)

    def instance(p, f):
        points = all_values[p, f]
        return sleap_io.PredictedInstance.from_numpy(
            points[:, :2], skeleton=skeleton, point_scores=np.nan_to_num(points[:, 2]), score=1.0, track=tracks[p]
        )

    frames = [sleap_io.LabeledFrame(video=video, frame_idx=f, instances=[instance(p, f) for p in range(people)]) for f in range(FRAMES)]
    return sleap_io.Labels(frames)


deeplabcut("dlc_table.h5", 1, format="table", **SMALL)
deeplabcut("dlc_fixed.h5", 1)
deeplabcut("dlc_individuals.h5", 2, format="table", **SMALL)
deeplabcut("dlc_images.h5", 1, rows_are=[f"img{f}.png" for f in range(FRAMES)], format="table", **SMALL)
sleap_io.save_analysis_h5(sleap(1), "sleap_one.h5")
sleap_io.save_analysis_h5(sleap(2), "sleap_frames_first.h5", preset="standard")
sleap_io.save_slp(sleap(1), "sleap_project.slp")
