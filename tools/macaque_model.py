#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Writes models/macaque_arm.osim: the right arm of a rhesus monkey in a sleeve of 16 LEDs.

    tools/macaque_model.py [OUT]        default models/macaque_arm.osim; "-" writes to stdout

Frames: x forward, y to the animal's left, z up, metres, the shoulder at the origin; all body frames are parallel in the
neutral pose (arm hanging, elbow straight, palm to the left). The sleeve is that of `kinemark simulate macaque`.

Sources
  upper arm 150 mm, forearm 160 mm: the arm that the macaque study simulates
  which joints have which freedoms: shoulder a ball, elbow a hinge, forearm turning about itself, wrist flexing and deviating,
    as in models of the macaque's reaching arm (Cheng & Scott 2000, J Morphol 245:206; Chan & Moran 2006, J Neural Eng 3:327)
Own, not measured on an animal: masses and inertias (even cylinders of soft tissue, 1050 kg/m^3, of the radii below), the hand,
ranges of motion, and the division of the forearm's mass between its bones.
"""
import math
import sys
from pathlib import Path

import human_model as osim
from human_model import X, Z, rotation

DOWN_Y = (0.0, -1.0, 0.0)  # turning about it moves what hangs forward
UPPER_ARM, FOREARM, HAND = 0.150, 0.160, 0.090
UPPER_ARM_RADIUS, FOREARM_RADIUS, HAND_RADIUS = 0.024, 0.017, 0.012
DENSITY = 1050.0
SLEEVE_RADIUS, LEDS = 0.022, 8


def cylinder(length, radius, share=1.0):
    """Mass, mass centre and (Ixx, Iyy, Izz) of `share` of an even cylinder that hangs from its upper joint."""
    mass = share * DENSITY * math.pi * radius**2 * length
    across = mass * (3 * radius**2 + length**2) / 12
    return mass, (0.0, 0.0, -length / 2), (across, across, mass * radius**2 / 2)


def segment(name, parent, at, body, joint, axes):
    mass, centre, inertia = body
    osim.add(name, parent, (0.0, 0.0, at), mass, centre, inertia, joint, axes)


def sleeve(body, prefix, length):
    for k in range(LEDS):
        angle = 3 * 2 * math.pi * k / LEDS
        position = (-SLEEVE_RADIUS * math.sin(angle), -SLEEVE_RADIUS * math.cos(angle), -length * (k + 1) / (LEDS + 1))
        osim.mark(f'{prefix}{k}', body, tuple(0.0 if abs(v) < 1e-15 else v for v in position))


def document():
    # Adduction first: near the mouth the elbow points to the other side, where flexion first would leave the rotation open.
    segment('humerus', 'ground', 0.0, cylinder(UPPER_ARM, UPPER_ARM_RADIUS), 'shoulder',
            [rotation('shoulder_adduction', X, -1.6, 2.4), rotation('shoulder_flexion', DOWN_Y, -1.4, 1.4),
             rotation('shoulder_rotation', Z, -3.1, 3.1)])
    segment('ulna', 'humerus', -UPPER_ARM, cylinder(FOREARM, FOREARM_RADIUS, 0.5), 'elbow',
            [rotation('elbow_flexion', DOWN_Y, 0.0, 2.7, 0.6)])
    segment('radius', 'ulna', 0.0, cylinder(FOREARM, FOREARM_RADIUS, 0.5), 'radioulnar', [rotation('pronation', Z, -1.6, 1.6)])
    segment('hand', 'radius', -FOREARM, cylinder(HAND, HAND_RADIUS), 'wrist',
            [rotation('wrist_flexion', DOWN_Y, -1.5, 1.5), rotation('wrist_deviation', X, -0.6, 0.6)])
    sleeve('humerus', 'u', UPPER_ARM)
    sleeve('radius', 'f', FOREARM)
    return osim.osim_document(
        'kinemark_macaque_arm',
        'The kinemark authors. Right arm of a rhesus monkey: segments of 150 and 160 mm as in the macaque study; joint types'
        ' as in Cheng and Scott (2000) and Chan and Moran (2006). Masses and inertias are even cylinders of 1050 kg/m^3, not'
        ' measured.', (0.0, 0.0, -9.80665), 'macaque_model.py')


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else str(Path(__file__).resolve().parent.parent / 'models' / 'macaque_arm.osim')
    text = document()
    if out == '-':
        sys.stdout.write(text)
    else:
        Path(out).write_text(text, encoding='utf-8', newline='\n')


if __name__ == '__main__':
    main()
