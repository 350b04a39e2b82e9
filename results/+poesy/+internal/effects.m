function found = effects(indices)
% What POESY.INTERNAL.RANKED takes, from the indices of a sensitivity study: index x sigma, SI; NaN for a response that does
% not vary, and 0 for an error without effect, because their indices are the rounding of solves.
  rounding = 1e-10;  % of an index, as the program has it (engine/stats/indices.h)
  is_rounding = indices.index < rounding;
  varies = any(indices.index >= rounding, 1) | all(isnan(indices.index), 1);
  scale = indices.sigma * ones(1, numel(indices.responses));
  scale(is_rounding) = 0;
  scale(:, ~varies) = NaN;
  found = struct('names', {indices.factors}, 'responses', {indices.responses}, 'units', {indices.response_units}, ...
                 'value', indices.index .* scale, 'low', indices.index_low .* scale, 'high', indices.index_high .* scale);
end
