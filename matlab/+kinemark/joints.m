% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = joints(input, varargin)
% RESULT = KINEMARK.JOINTS(INPUT, ...) finds joint centres and axes from markers, each with its covariance.
%   result.report    segments, joints, lengths, as skeleton.json holds them
%   result.centres   trial of the centres through time; [] where no joint is known
%   result.passed    false where a joint is not determined
% INPUT is a file or a trial. 'output', FOLDER writes the files too. Options are those of 'kinemark joints'.
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  [output, rest] = kinemark.internal.split(varargin, 'output', fullfile(folder, 'joints'));
  options = kinemark.internal.words(rest{:});
  input = kinemark.internal.file_of(input, folder);
  [result.report, result.passed] = kinemark.internal.call('joints', input, ['--output=' output], options{:});
  result.centres = [];
  centres = fullfile(output, 'centres.c3d');
  if exist(centres, 'file'), result.centres = kinemark.read(centres); end
end
