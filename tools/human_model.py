#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Writes models/human.osim: a man of 75 kg and 1.75 m, 26 joints, 40 coordinates, 40 markers.

    tools/human_model.py [OUT]        default models/human.osim; "-" writes to stdout

Frames: x forward, y up, z to the right, metres; all body frames are parallel in the neutral pose (standing, arms hanging,
palms forward). Everything on the right side is written once and mirrored.

Sources
  masses, mass centres, transverse radii of gyration, densities: Winter (2009), Biomechanics and Motor Control of Human
    Movement, 4th ed., table 4.1 (after Dempster 1955 and others)
  segment lengths as fractions of body height: Drillis & Contini (1966), as drawn in Winter (2009), figure 4.1
  directions of the ankle and subtalar axes: Inman (1976), The Joints of the Ankle; in the form and with the coordinate names
    that OpenSim's full-body models use (Hamner et al. 2010; Rajagopal et al. 2016), and so are elbow and forearm axes
What table 4.1 does not give is modelled here and marked "own": radii of gyration about the long axis (an even cylinder of the
segment's density), thorax, abdomen and pelvis (even elliptic cylinders), and the division of forearm, hand, foot and shoulder
girdle into the parts that move separately.
"""
import math
import sys
from pathlib import Path

MASS_KG = 75.0
HEIGHT_M = 1.75

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def height(fraction):
    return fraction * HEIGHT_M


# Heights above the floor, standing (Drillis & Contini).
ANKLE, KNEE, HIP = height(0.039), height(0.285), height(0.530)
SHOULDER, ELBOW, WRIST, FINGERTIP = height(0.818), height(0.630), height(0.485), height(0.377)
THIGH, SHANK, UPPER_ARM, FOREARM, HAND = HIP - KNEE, KNEE - ANKLE, SHOULDER - ELBOW, ELBOW - WRIST, WRIST - FINGERTIP
FOOT = height(0.152)
# Own: heights of the origin of the pelvis (midway between its front spines), the joint of pelvis and spine, the diaphragm
# (T12-L1), the neck joint (C7-T1) and the ear canal.
PELVIS, LUMBAR, DIAPHRAGM, NECK, EAR = 1.004, 1.085, 1.235, 1.495, 1.630
PALM = 0.51 * HAND

# Winter's table 4.1: mass fraction, mass centre from the proximal end, radius of gyration about it (of the length), kg/m^3.
WINTER = {
    'hand': (0.006, 0.506, 0.297, 1160.0),
    'forearm': (0.016, 0.430, 0.303, 1130.0),
    'upper_arm': (0.028, 0.436, 0.322, 1070.0),
    'foot': (0.0145, 0.500, 0.475, 1100.0),
    'leg': (0.0465, 0.433, 0.302, 1090.0),
    'thigh': (0.100, 0.433, 0.323, 1050.0),
    'head_and_neck': (0.081, 1.000, 0.495, 1110.0),
    'thorax': (0.216, 0.82, None, 920.0),
    'abdomen': (0.139, 0.44, None, None),
    'pelvis': (0.142, 0.105, None, None),
}


def rod(name, length, share=1.0):
    """Mass and (Ixx, Iyy, Izz) of `share` of a segment of the table that lies along y."""
    fraction, _, gyration, density = WINTER[name]
    mass = fraction * MASS_KG
    across = mass * (gyration * length) ** 2
    along = mass * mass / (density * math.pi * length) / 2.0  # own: m r^2 / 2 of a cylinder of the segment's volume
    return share * mass, tuple(share * i for i in (across, along, across))


def elliptic_cylinder(mass, half_depth, half_width, length):
    """(Ixx, Iyy, Izz) of an even elliptic cylinder along y; depth along x, width along z."""
    a, b = half_depth**2, half_width**2
    return (mass * (3 * b + length**2) / 12, mass * (a + b) / 4, mass * (3 * a + length**2) / 12)


def box(mass, x, y, z):
    return (mass * (y * y + z * z) / 12, mass * (x * x + z * z) / 12, mass * (x * x + y * y) / 12)


def unit(v):
    n = math.sqrt(sum(x * x for x in v))
    return tuple(x / n for x in v)


def mirror_point(v):
    return (v[0], v[1], -v[2])


def mirror_axis(v):
    """Turning by the same angle about the mirrored axis is the mirrored motion."""
    return tuple(-x if x and i < 2 else x for i, x in enumerate(v))


def coordinate(name, low, high, default=0.0, clamped=True):
    return {'name': name, 'range': (low, high), 'default': default, 'clamped': clamped}


bodies, joints, markers = [], [], []


def add(name, parent, offset, mass, com, inertia, joint, axes):
    """axes: (coordinate, axis, is_rotation); turns in order. None: welded."""
    bodies.append({'name': name, 'mass': mass, 'com': com, 'inertia': inertia})
    joints.append({'name': joint, 'parent': parent, 'child': name, 'offset': offset, 'axes': axes})


def add_pair(name, parent, offset, mass, com, inertia, joint, axes, paired_parent=True):
    for side in 'rl':
        point = mirror_point if side == 'l' else (lambda v: v)
        axis = mirror_axis if side == 'l' else (lambda v: v)
        add(f'{name}_{side}', f'{parent}_{side}' if paired_parent else parent, point(offset), mass, point(com), inertia,
            f'{joint}_{side}', [({**c, 'name': f"{c['name']}_{side}"}, axis(a), r) for c, a, r in axes])


def rotation(name, axis, low, high, default=0.0):
    return (coordinate(name, low, high, default), unit(axis), True)


def mark(name, body, at):
    markers.append((name, body, at))


def mark_pair(name, body, at, paired_body=True):
    """PiG order: left before right."""
    for side in 'lr':
        mark(side.upper() + name, f'{body}_{side}' if paired_body else body, mirror_point(at) if side == 'l' else at)


def build_trunk():
    root = [(coordinate(n, -math.pi, math.pi, clamped=False), a, True)
            for n, a in (('pelvis_tilt', Z), ('pelvis_list', X), ('pelvis_rotation', Y))]
    root += [(coordinate(n, -10.0, 10.0, d, clamped=False), a, False)
             for n, a, d in (('pelvis_tx', X, 0.0), ('pelvis_ty', Y, PELVIS), ('pelvis_tz', Z, 0.0))]
    mass = WINTER['pelvis'][0] * MASS_KG
    hip_y = HIP - PELVIS
    # From L4-L5 towards the hips; own: 50 mm behind the plane of the front spines.
    com_y = (LUMBAR + 0.02 - PELVIS) * (1 - WINTER['pelvis'][1]) + hip_y * WINTER['pelvis'][1]
    add('pelvis', 'ground', (0.0, 0.0, 0.0), mass, (-0.050, com_y, 0.0), elliptic_cylinder(mass, 0.10, 0.165, 0.19), 'ground_pelvis',
        root)

    mass = WINTER['abdomen'][0] * MASS_KG
    length = DIAPHRAGM - LUMBAR
    add('abdomen', 'pelvis', (-0.070, LUMBAR - PELVIS, 0.0), mass, (0.035, length * (1 - WINTER['abdomen'][1]), 0.0),
        elliptic_cylinder(mass, 0.105, 0.15, length), 'back',
        [rotation('lumbar_extension', Z, -1.2, 0.6), rotation('lumbar_bending', X, -0.6, 0.6), rotation('lumbar_rotation', Y, -0.8, 0.8)])

    # The shoulder girdles (own: 1 % of the body each) are taken out of the thorax so that all three together have the table's
    # mass and mass centre.
    total, length = WINTER['thorax'][0] * MASS_KG, NECK - DIAPHRAGM
    girdle = 0.01 * MASS_KG
    mass = total - 2 * girdle
    girdle_at, girdle_com = (0.015, SHOULDER + 0.02 - DIAPHRAGM, 0.025), (-0.025, 0.005, 0.08)
    table_com = (0.025, length * (1 - WINTER['thorax'][1]), 0.0)
    com = tuple((total * t - 2 * girdle * (a + c)) / mass for t, a, c in zip(table_com[:2], girdle_at, girdle_com)) + (0.0,)
    add('thorax', 'abdomen', (0.005, DIAPHRAGM - LUMBAR, 0.0), mass, com, elliptic_cylinder(mass, 0.11, 0.15, length), 'diaphragm', [])

    mass, inertia = rod('head_and_neck', EAR - NECK)
    # Own: the cylinder of this short length would be too thick about the long axis; a head is nearly as wide as deep.
    inertia = (inertia[0], 0.8 * inertia[0], inertia[2])
    add('head', 'thorax', (-0.005, NECK - DIAPHRAGM, 0.0), mass, (0.025, (EAR - NECK) * WINTER['head_and_neck'][1], 0.0), inertia,
        'neck', [rotation('neck_extension', Z, -1.0, 1.0), rotation('neck_bending', X, -0.7, 0.7), rotation('neck_rotation', Y, -1.3, 1.3)])
    add_pair('clavicle', 'thorax', girdle_at, girdle, girdle_com, box(girdle, 0.10, 0.10, 0.15), 'sternoclavicular', [],
             paired_parent=False)
    return girdle_at


def build_arms(girdle_at):
    shoulder = (0.0 - girdle_at[0], SHOULDER - DIAPHRAGM - girdle_at[1], height(0.259) / 2 - 0.04 - girdle_at[2])
    mass, inertia = rod('upper_arm', UPPER_ARM)
    add_pair('humerus', 'clavicle', shoulder, mass, (0.0, -WINTER['upper_arm'][1] * UPPER_ARM, 0.0), inertia, 'acromial',
             [rotation('arm_flex', Z, -1.2, 2.8, 0.0), rotation('arm_add', X, -2.2, 0.8, 0.0), rotation('arm_rot', Y, -1.6, 1.6)])
    # Own: half of the forearm to each bone.
    mass, inertia = rod('forearm', FOREARM, 0.5)
    com = -WINTER['forearm'][1] * FOREARM
    radius_at = (-0.007, -0.013, 0.026)
    add_pair('ulna', 'humerus', (0.0, -UPPER_ARM, 0.0), mass, (0.0, com, 0.010), inertia, 'elbow',
             [rotation('elbow_flex', (0.226, 0.022, 0.974), 0.0, 2.6, 0.0)])
    add_pair('radius', 'ulna', radius_at, mass, (-radius_at[0], com - radius_at[1], -0.006), inertia, 'radioulnar',
             [rotation('pro_sup', (0.056, 0.998, 0.002), -0.2, 1.9, 0.0)])
    # Own: 60 % of the hand to the palm. The mass centre of palm and fingers lies at 0.506 of wrist to knuckle II, 0.78 of HAND.
    mass, com = WINTER['hand'][0] * MASS_KG, WINTER['hand'][1] * 0.78 * HAND
    palm, fingers = 0.6 * mass, 0.4 * mass
    palm_com = 0.45 * PALM
    fingers_com = (mass * com - palm * palm_com) / fingers - PALM
    wrist = (-radius_at[0], -FOREARM - radius_at[1], -0.009)
    add_pair('hand', 'radius', wrist, palm, (0.0, -palm_com, 0.0), box(palm, 0.03, PALM, 0.085), 'radius_hand',
             [rotation('wrist_flex', Z, -1.3, 1.3), rotation('wrist_dev', X, -0.5, 0.7)])
    add_pair('fingers', 'hand', (0.0, -PALM, 0.0), fingers, (0.008, -fingers_com, 0.0), box(fingers, 0.02, HAND - PALM, 0.08),
             'knuckles', [])


def build_legs():
    mass, inertia = rod('thigh', THIGH)
    add_pair('femur', 'pelvis', (-0.060, HIP - PELVIS, 0.085), mass, (0.0, -WINTER['thigh'][1] * THIGH, 0.0), inertia, 'hip',
             [rotation('hip_flexion', Z, -0.8, 2.2), rotation('hip_adduction', X, -0.9, 0.6), rotation('hip_rotation', Y, -0.8, 0.8)],
             paired_parent=False)
    mass, inertia = rod('leg', SHANK)
    add_pair('tibia', 'femur', (0.0, -THIGH, 0.0), mass, (0.0, -WINTER['leg'][1] * SHANK, 0.0), inertia, 'knee',
             [rotation('knee_angle', (0.0, 0.0, -1.0), 0.0, 2.4)])
    # Own: a tenth of the foot to the talus and a fifth to the toes. Foot from 60 mm behind the ankle, mass centre of all
    # three midway between the malleolus and the head of metatarsal II (130 mm ahead).
    mass = WINTER['foot'][0] * MASS_KG
    talus, calcn, toes = 0.1 * mass, 0.7 * mass, 0.2 * mass
    calcn_at, toes_at = (-0.049, -0.042, 0.008), (0.179, -0.002, 0.001)
    toes_com = (0.035, 0.004, -0.015)
    wanted = WINTER['foot'][1] * 0.130
    calcn_x = (mass * wanted - talus * 0.005 - toes * (calcn_at[0] + toes_at[0] + toes_com[0])) / calcn - calcn_at[0]
    add_pair('talus', 'tibia', (0.0, -SHANK, 0.0), talus, (0.005, -0.005, 0.0), box(talus, 0.05, 0.04, 0.04), 'ankle',
             [rotation('ankle_angle', (-0.105, -0.174, 0.979), -0.9, 0.6)])
    add_pair('calcn', 'talus', calcn_at, calcn, (calcn_x, 0.025, 0.0), box(calcn, 0.75 * FOOT, 0.07, 0.08), 'subtalar',
             [rotation('subtalar_angle', (0.787, 0.605, -0.121), -0.5, 0.5)])
    add_pair('toes', 'calcn', toes_at, toes, toes_com, box(toes, 0.07, 0.03, 0.09), 'mtp',
             [rotation('mtp_angle', (-0.581, 0.0, 0.815), -0.7, 0.9)])


def build_markers():
    """Names of the Plug-in Gait set, without RBAK, with one more on the front of each thigh."""
    mark_pair('FHD', 'head', (0.110, 0.155, 0.060), paired_body=False)
    mark_pair('BHD', 'head', (-0.080, 0.165, 0.060), paired_body=False)
    top = NECK - DIAPHRAGM
    mark('C7', 'thorax', (-0.085, top + 0.015, 0.0))
    mark('T10', 'thorax', (-0.105, 0.055, 0.0))
    mark('CLAV', 'thorax', (0.065, top - 0.070, 0.0))
    mark('STRN', 'thorax', (0.115, 0.075, 0.0))
    mark_pair('SHO', 'clavicle', (-0.025, 0.035, 0.150))
    mark_pair('UPA', 'humerus', (0.015, -0.45 * UPPER_ARM, 0.050))
    mark_pair('ELB', 'humerus', (0.0, -UPPER_ARM + 0.005, 0.048))
    mark_pair('FRM', 'ulna', (0.030, -0.55 * FOREARM, 0.030))
    mark_pair('WRA', 'radius', (0.007, -FOREARM + 0.025, 0.030))
    mark_pair('WRB', 'radius', (0.000, -FOREARM + 0.025, -0.048))
    mark_pair('FIN', 'hand', (-0.020, -PALM + 0.005, 0.020))
    mark_pair('ASI', 'pelvis', (0.020, 0.010, 0.125), paired_body=False)
    mark_pair('PSI', 'pelvis', (-0.160, 0.020, 0.045), paired_body=False)
    mark_pair('THI', 'femur', (0.010, -0.50 * THIGH, 0.090))
    mark_pair('THAP', 'femur', (0.085, -0.62 * THIGH, 0.025))
    mark_pair('KNE', 'femur', (0.000, -THIGH + 0.010, 0.055))
    mark_pair('TIB', 'tibia', (0.030, -0.48 * SHANK, 0.045))
    mark_pair('ANK', 'tibia', (-0.005, -SHANK + 0.005, 0.048))
    mark_pair('HEE', 'calcn', (-0.020, 0.022, 0.000))
    mark_pair('TOE', 'toes', (0.055, 0.022, 0.005))


def number(x):
    text = f'{x:.12g}'
    return '0' if text == '-0' else text


def numbers(v):
    return ' '.join(number(x) for x in v)


def frame_angles(axis):
    """Body-fixed X-Y-Z angles of a frame whose z axis is `axis`."""
    return (math.atan2(-axis[1], axis[2]), math.asin(max(-1.0, min(1.0, axis[0]))), 0.0)


def coordinate_xml(c):
    return f'''            <Coordinate name="{c['name']}">
              <default_value>{number(c['default'])}</default_value>
              <default_speed_value>0</default_speed_value>
              <range>{numbers(c['range'])}</range>
              <clamped>{str(c['clamped']).lower()}</clamped>
              <locked>false</locked>
              <prescribed>false</prescribed>
            </Coordinate>'''


def axis_xml(name, coordinate_name, axis):
    function = ('<LinearFunction name="function">\n                <coefficients>1 0</coefficients>\n              </LinearFunction>'
                if coordinate_name else
                '<Constant name="function">\n                <value>0</value>\n              </Constant>')
    return f'''            <TransformAxis name="{name}">
              <coordinates>{coordinate_name}</coordinates>
              <axis>{numbers(axis)}</axis>
              {function}
            </TransformAxis>'''


def joint_xml(j):
    rotations = [a for a in j['axes'] if a[2]]
    translations = [a for a in j['axes'] if not a[2]]
    pin = len(rotations) == 1 and not translations
    kind = 'PinJoint' if pin else 'CustomJoint' if rotations else 'WeldJoint'
    angles = frame_angles(rotations[0][1]) if pin else (0.0, 0.0, 0.0)
    lines = [f'        <{kind} name="{j["name"]}">',
             f'          <socket_parent_frame>{j["parent"]}_offset</socket_parent_frame>',
             f'          <socket_child_frame>{j["child"]}_offset</socket_child_frame>']
    if j['axes']:
        lines += ['          <coordinates>', *(coordinate_xml(c) for c, _, _ in j['axes']), '          </coordinates>']
    lines.append('          <frames>')
    for body, position in ((j['parent'], j['offset']), (j['child'], (0.0, 0.0, 0.0))):
        path = '/ground' if body == 'ground' else f'/bodyset/{body}'
        lines += [f'            <PhysicalOffsetFrame name="{body}_offset">',
                  f'              <socket_parent>{path}</socket_parent>',
                  f'              <translation>{numbers(position)}</translation>',
                  f'              <orientation>{numbers(angles)}</orientation>',
                  '            </PhysicalOffsetFrame>']
    lines.append('          </frames>')
    if kind == 'CustomJoint':
        axes = [(c['name'], a) for c, a, _ in rotations]
        axes += [('', a) for a in (Z, X, Y) if a not in [b for _, b in axes] and tuple(-x for x in a) not in
                 [tuple(y + 0.0 for y in b) for _, b in axes]][:3 - len(axes)]
        shifts = [(c['name'], a) for c, a, _ in translations] or [('', X), ('', Y), ('', Z)]
        lines.append('          <SpatialTransform>')
        lines += [axis_xml(f'rotation{i + 1}', *a) for i, a in enumerate(axes)]
        lines += [axis_xml(f'translation{i + 1}', *a) for i, a in enumerate(shifts)]
        lines.append('          </SpatialTransform>')
    lines.append(f'        </{kind}>')
    return '\n'.join(lines)


def osim_document(name, credit, gravity, script):
    """What was added so far as an OpenSim document."""
    def body_xml(b):
        return f'''        <Body name="{b['name']}">
          <mass>{number(b['mass'])}</mass>
          <mass_center>{numbers(b['com'])}</mass_center>
          <inertia>{numbers(b['inertia'])} 0 0 0</inertia>
        </Body>'''

    def marker_xml(m):
        return f'''        <Marker name="{m[0]}">
          <socket_parent_frame>/bodyset/{m[1]}</socket_parent_frame>
          <location>{numbers(m[2])}</location>
          <fixed>false</fixed>
        </Marker>'''

    new_line = '\n'
    return f'''<?xml version="1.0" encoding="UTF-8" ?>
<!-- SPDX-FileCopyrightText: 2026 The kinemark authors -->
<!-- SPDX-License-Identifier: Apache-2.0 -->
<!-- Written by tools/{script}; edit that, not this. -->
<OpenSimDocument Version="40000">
  <Model name="{name}">
    <credits>{credit}</credits>
    <length_units>meters</length_units>
    <force_units>N</force_units>
    <gravity>{numbers(gravity)}</gravity>
    <Ground name="ground" />
    <BodySet name="bodyset">
      <objects>
{new_line.join(body_xml(b) for b in bodies)}
      </objects>
      <groups />
    </BodySet>
    <JointSet name="jointset">
      <objects>
{new_line.join(joint_xml(j) for j in joints)}
      </objects>
      <groups />
    </JointSet>
    <MarkerSet name="markerset">
      <objects>
{new_line.join(marker_xml(m) for m in markers)}
      </objects>
      <groups />
    </MarkerSet>
  </Model>
</OpenSimDocument>
'''


def document():
    build_arms(build_trunk())
    build_legs()
    build_markers()
    assert len(joints) == 26 and len(markers) == 40 and sum(len(j['axes']) for j in joints) == 40
    assert abs(sum(b['mass'] for b in bodies) - MASS_KG) < 1e-9
    return osim_document('kinemark_human',
                         f'The kinemark authors. Whole body, {number(MASS_KG)} kg, {number(HEIGHT_M)} m.'
                         ' Masses, mass centres and radii of gyration: Winter (2009), table 4.1, after Dempster (1955).'
                         ' Segment lengths: Drillis and Contini (1966).'
                         ' Coordinate names as in Hamner et al. (2010) and Rajagopal et al. (2016).',
                         (0.0, -9.80665, 0.0), 'human_model.py')


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else str(Path(__file__).resolve().parent.parent / 'models' / 'human.osim')
    text = document()
    if out == '-':
        sys.stdout.write(text)
    else:
        Path(out).write_text(text, encoding='utf-8', newline='\n')


if __name__ == '__main__':
    main()
