function result = indices(factors, factor_units, sigma, responses, response_units, index, low, high)
% POESY.INTERNAL.INDICES  The indices of a sensitivity study with P errors and R responses, result.sensitivity of POESY.READ:
%   factors, factor_units            {P x 1}  names and SI units of the errors
%   responses, response_units        {R x 1}
%   sigma                            [P x 1]  standard deviation of each error, SI
%   index, index_low, index_high     [P x R]  corrected global index and its interval, SI: response unit per factor unit
%   effect, effect_low, effect_high  [P x R]  index x sigma, in effect_units {R x 1}: mm, deg
%   rank                             [P x R]  rank(k, r) is the error that has the k-th largest effect on response r
  result.kind = 'sensitivity';
  result.factors = factors(:);
  result.factor_units = factor_units(:);
  result.responses = responses(:);
  result.response_units = response_units(:);
  result.sigma = sigma(:);
  result.index = index;
  result.index_low = low;
  result.index_high = high;
  [scale, result.effect_units] = poesy.internal.readable(result.response_units);
  to_effect = result.sigma * scale;
  result.effect = index .* to_effect;
  result.effect_low = low .* to_effect;
  result.effect_high = high .* to_effect;
  spread = result.effect;
  spread(isnan(spread)) = -1;  % an index that is not known ranks last
  [~, result.rank] = sort(spread, 1, 'descend');
end
