% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function list = words(varargin)
% LIST = WORDS('max_gap', 2, 'derivatives', true, ...) is {'--max-gap=2', '--derivatives', ...}.
% [] and false leave an option out; a cell gives it several times; a struct, NAME=VALUE for each field.
  if mod(numel(varargin), 2) ~= 0
    error('kinemark:usage', 'options are pairs of a name and a value; the last has no value');
  end
  list = {};
  for i = 1:2:numel(varargin)
    name = varargin{i};
    if ~ischar(name), error('kinemark:usage', 'options are pairs of a name and a value; name %d is no text', (i + 1) / 2); end
    list = [list, one(['--' strrep(name, '_', '-')], varargin{i + 1})]; %#ok<AGROW>
  end
end

function list = one(option, value)
  if islogical(value) && isscalar(value)
    list = {};
    if value, list = {option}; end
  elseif iscell(value)
    list = cellfun(@(item) [option '=' text(option, item)], value(:)', 'UniformOutput', false);
  elseif isstruct(value) && isscalar(value)
    names = fieldnames(value)';
    list = cellfun(@(name) [option '=' name '=' text(option, value.(name))], names, 'UniformOutput', false);
  elseif isempty(value) && ~ischar(value)
    list = {};
  else
    list = {[option '=' text(option, value)]};
  end
end

function word = text(option, value)
  if ischar(value)
    word = value;
  elseif isa(value, 'string') && isscalar(value)
    word = char(value);
  elseif isnumeric(value) && isscalar(value)
    word = sprintf('%.17g', value);
  else
    error('kinemark:usage', '%s is a %s; need a text or a number, or a cell of them', option, class(value));
  end
end
