% SPDX-FileCopyrightText: 2026 The kinemark authors
% SPDX-License-Identifier: Apache-2.0
function result = scale(model, static, output, varargin)
% RESULT = KINEMARK.SCALE('model.osim', STATIC, 'subject.osim', ...) makes a model fit a subject.
%   result.model    path of the model that was written
%   result.report   sizes and places of markers, each with its standard deviation
%   result.passed   false where the markers fit worse than the gate
% STATIC is a file or a trial. Options are those of 'kinemark scale'; with 'setup', FILE model and STATIC may be [].
  [folder, guard] = kinemark.internal.scratch(); %#ok<ASGLU>
  options = kinemark.internal.words(varargin{:});
  if ~isempty(static), options = [{['--static=' kinemark.internal.file_of(static, folder)]}, options]; end
  if ~isempty(model), options = [{['--model=' model]}, options]; end
  [result.report, result.passed] = kinemark.internal.call('scale', ['--output=' output], options{:});
  result.model = output;
end
