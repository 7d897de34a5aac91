% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = measure(input, varargin)
% RESULT = KINEMARK.MEASURE(INPUT, ...) measures paths of markers: shape, timing, smoothness, each with an interval.
%   result.measures   struct array: measure, subject, value, unit, interval, ...; a cell where they have different fields
%   result.report     all that the program's JSON holds
%   result.passed     false where a quality gate was missed
% INPUT is a file or a trial. 'output', FILE writes the table too. Options are those of 'kinemark measure':
%   kinemark.measure('reach.c3d', 'measures', 'path_length', 'refits', 0)
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  options = kinemark.internal.words(varargin{:});
  [result.report, result.passed] = kinemark.internal.call('measure', kinemark.internal.file_of(input, folder), options{:});
  result.measures = result.report.measures;
end
