% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function write(trial, file, varargin)
% KINEMARK.WRITE(TRIAL, 'walk.c3d', ...) writes a trial to .c3d, .trc, .csv, .nwb, .mat or another format that the program writes.
% TRIAL is as kinemark.read gives it, or a struct with rate (Hz), labels and data (frames x markers x 3, m).
% A file that is there is kept unless 'force', true says otherwise.
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  options = kinemark.internal.words(varargin{:});
  kinemark.internal.call('convert', kinemark.internal.file_of(trial, folder), file, options{:});
end
