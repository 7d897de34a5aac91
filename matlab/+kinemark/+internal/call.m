% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function [report, passed] = call(varargin)
% [REPORT, PASSED] = CALL(WORD, ...) runs the program; REPORT is its JSON, PASSED false where a quality gate was missed.
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  out = fullfile(folder, 'out.json');
  err = fullfile(folder, 'err.txt');
  program = getenv('KINEMARK_PROGRAM');
  if isempty(program), program = 'kinemark'; end
  quoted = cellfun(@kinemark.internal.quote, [{program}, varargin, {'--quiet', '--json'}], 'UniformOutput', false);
  line = [strjoin(quoted, ' ') ' > ' kinemark.internal.quote(out) ' 2> ' kinemark.internal.quote(err)];
  if isunix() && ~exist('OCTAVE_VERSION', 'builtin')
    line = ['unset LD_LIBRARY_PATH; ' line];  % MATLAB's own libraries are older than the program's
  end
  status = system(line);
  if status > 1
    fail(program, status, fileread(err));
  end
  passed = status == 0;
  text = fileread(out);
  report = struct();
  if ~isempty(strtrim(text)), report = jsondecode(text); end
end

function fail(program, status, words)
  kinds = {'', 'usage', 'input', 'file', 'device'};
  kind = 'failed';
  if status <= 5, kind = kinds{status}; end
  if any(status == [126 127 9009])
    error('kinemark:absent', '%s cannot be started (exit status %d); setenv KINEMARK_PROGRAM to the path of the program', program, status);
  end
  lines = strsplit(strtrim(words), sprintf('\n'));
  sentence = regexprep(lines{end}, '^kinemark: ', '');
  error(['kinemark:' kind], '%s (exit status %d)', sentence, status);
end
