% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = read(file, varargin)
% TRIAL = KINEMARK.READ('walk.c3d', ...) reads a recording of any format that the program knows.
%   trial.data is frames x markers x 3 in metres, NaN where missing; trial.labels, trial.time, trial.rate, trial.status, ...
% TABLE = KINEMARK.READ('walk.mot') reads a table: table.time, table.labels, table.data (rows x columns).
% Options are those of 'kinemark convert', as pairs: kinemark.read('walk.c3d', 'select', 'L*', 'frames', '101-250').
% All fields: docs/formats/mat.md.
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  options = kinemark.internal.words(varargin{:});
  made = fullfile(folder, 'read.mat');
  kinemark.internal.call('convert', kinemark.internal.file_of(file, folder), made, options{:});
  held = load(made);
  if isfield(held, 'trial'), result = held.trial; else, result = held.table; end
end
