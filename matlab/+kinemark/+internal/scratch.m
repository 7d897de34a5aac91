% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function [folder, guard] = scratch()
% [FOLDER, GUARD] = SCRATCH() makes a folder that is removed when GUARD is cleared.
  folder = tempname();
  [made, message] = mkdir(folder);
  if ~made, error('kinemark:file', '%s: %s', folder, message); end
  guard = onCleanup(@() remove(folder));
end

function remove(folder)
  for file = dir(folder)'
    if file.isdir && ~any(strcmp(file.name, {'.', '..'}))
      remove(fullfile(folder, file.name));
    elseif ~file.isdir
      delete(fullfile(folder, file.name));
    end
  end
  rmdir(folder);
end
