% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function [value, rest] = split(options, name, usual)
% [VALUE, REST] = SPLIT(OPTIONS, NAME, USUAL) takes the option NAME out of pairs.
  value = usual;
  rest = options;
  at = find(strcmp(options(1:2:end), name));
  if isempty(at), return, end
  if 2 * at(end) > numel(options), return, end
  value = options{2 * at(end)};
  rest([2 * at - 1, 2 * at]) = [];
end
