% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = clean(input, varargin)
% RESULT = KINEMARK.CLEAN(INPUT, 'gaps', 'auto', ...) fills gaps and smooths noise.
%   result.trial    the recording, cleaned, with states and standard deviations
%   result.report   what was done to each marker and why
%   result.passed   false where a quality gate was missed
% INPUT is a file or a trial. 'output', 'walk_clean.c3d' writes the file too. Options are those of 'kinemark clean'.
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  [output, rest] = kinemark.internal.split(varargin, 'output', fullfile(folder, 'clean.mat'));
  options = kinemark.internal.words(rest{:});
  [result.report, result.passed] = kinemark.internal.call('clean', kinemark.internal.file_of(input, folder), output, options{:});
  result.trial = kinemark.read(output);
end
