% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function path = file_of(input, folder)
% PATH = FILE_OF(INPUT, FOLDER) is INPUT where that names a file; a trial in memory is written into FOLDER,
% which needs labels, rate (Hz) and data (frames x markers x 3, m).
  if isstruct(input) && isfield(input, 'data') && isfield(input, 'labels') && isfield(input, 'rate')
    path = fullfile(folder, 'trial.mat');
    frames = size(input.data, 1);
    usual = struct('kinemark', 1, 'units', 'm', 'start', 0, 'first_frame', 1, 'frames', frames);
    usual.time = (0:frames - 1)' / input.rate;
    usual.status = uint8(~any(isnan(input.data), 3));  % measured or missing
    trial = input;
    for name = fieldnames(usual)'
      if ~isfield(trial, name{1}), trial.(name{1}) = usual.(name{1}); end
    end
    save(path, 'trial', '-v7');
  elseif ischar(input)
    path = input;
  elseif isa(input, 'string') && isscalar(input)
    path = char(input);
  else
    error('kinemark:usage', 'input is a %s; need the path of a file, or a trial as kinemark.read gives it', class(input));
  end
  if ~isempty(path) && path(1) == '-', path = fullfile('.', path); end
end
