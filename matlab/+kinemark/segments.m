% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = segments(input, definition, varargin)
% RESULT = KINEMARK.SEGMENTS(INPUT, 'pig', ...) finds segments, joint centres and angles by a definition.
%   result.angles   table: time, labels, data (degrees); result.sd the same of standard deviations; [] without
%   result.report   parameters of the subject, comparison with the file's own angles
%   result.passed   false where a quality gate was missed
% INPUT is a file or a trial. 'output', FOLDER writes the files too. Options are those of 'kinemark segments'.
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  [output, rest] = kinemark.internal.split(varargin, 'output', fullfile(folder, 'segments'));
  options = kinemark.internal.words(rest{:});
  input = kinemark.internal.file_of(input, folder);
  [result.report, result.passed] = ...
      kinemark.internal.call('segments', input, ['--definition=' definition], ['--output=' output], options{:});
  result.angles = table_of(fullfile(output, 'angles.mot'));
  result.sd = table_of(fullfile(output, 'angles_sd.sto'));
end

function table = table_of(path)
  table = [];
  if exist(path, 'file'), table = kinemark.read(path); end
end
