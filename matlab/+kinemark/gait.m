% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = gait(input, varargin)
% RESULT = KINEMARK.GAIT(INPUT, ...) finds events of feet, strides and steps, each with an interval.
%   result.measures   struct array: measure, subject, value, unit, interval, ...; a cell where they have different fields
%   result.report     all that the program's JSON holds
%   result.passed     false where a quality gate was missed
% INPUT is a file or a trial. 'output', FILE writes the table too. Options are those of 'kinemark gait':
%   kinemark.gait('walk.c3d', 'events', 'plates')
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  options = kinemark.internal.words(varargin{:});
  [result.report, result.passed] = kinemark.internal.call('gait', kinemark.internal.file_of(input, folder), options{:});
  result.measures = result.report.measures;
end
