% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = ik(model, markers, varargin)
% RESULT = KINEMARK.IK('subject.osim', INPUT, ...) finds joint angles from markers, each with its standard deviation.
%   result.motion          table: time, labels, data (degrees, metres)
%   result.sd              the same of standard deviations, NaN where not determined; [] with 'no_error_bars', true
%   result.marker_errors   table of distances, m
%   result.report          errors by coordinate and marker, findings, gates
%   result.passed          false where a quality gate was missed
% INPUT is a file or a trial. 'output', 'walk.mot' writes the files too. Options are those of 'kinemark ik':
%   kinemark.ik('subject.osim', 'walk.c3d', 'weight', {'RTOE=2', 'LTOE=2'}, 'start', 0.5)
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  [output, rest] = kinemark.internal.split(varargin, 'output', fullfile(folder, 'motion.mot'));
  options = kinemark.internal.words(rest{:});
  markers = kinemark.internal.file_of(markers, folder);
  [result.report, result.passed] = kinemark.internal.call('ik', ['--model=' model], ['--markers=' markers], ['--output=' output], options{:});
  [where, name] = fileparts(output);
  beside = @(ending) fullfile(where, [name ending]);
  result.motion = kinemark.read(output);
  result.marker_errors = kinemark.read(beside('_marker_errors.sto'));
  result.sd = [];
  if any(strcmp(options, '--no-error-bars')), return, end
  result.sd = kinemark.read(beside('_sd.sto'));
end
