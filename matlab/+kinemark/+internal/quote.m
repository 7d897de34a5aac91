% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function quoted = quote(word)
% QUOTED = QUOTE(WORD) is WORD as one word of the shell, whatever is in it.
  if ispc()
    quoted = ['"' strrep(word, '"', '\"') '"'];
  else
    quoted = ['''' strrep(word, '''', '''\''''') ''''];
  end
end
