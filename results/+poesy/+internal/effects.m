function found = effects(indices)
% What POESY.INTERNAL.RANKED takes, from the indices of a sensitivity study: index x sigma, SI.
  each = ones(1, numel(indices.responses));
  found = struct('names', {indices.factors}, 'responses', {indices.responses}, 'units', {indices.response_units}, ...
                 'value', indices.index .* (indices.sigma * each), 'low', indices.index_low .* (indices.sigma * each), ...
                 'high', indices.index_high .* (indices.sigma * each));
end
