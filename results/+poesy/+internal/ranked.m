function table = ranked(kind, found)
% result.ranked of POESY.READ, from the quantities of a result of this kind: names, responses, units (SI), value [N x R],
% and low, high where there are intervals; and of some kinds what is said below.
  switch kind
    case 'sensitivity'
      what = 'global index x sigma';
    case 'monte-carlo'
      what = 'first-order index S1';
    case 'sobol'
      what = 'total index ST';
    case 'allocation'  % mean_square_share [N x 1], because an aim without costs has no share of them
      what = 'share of the cost of all';
      if all(isnan(found.value))
        what = 'share of the mean square under the tightest limit';
        found.value = found.mean_square_share;
      end
    case 'coupling'  % sizes: how often the names are repeated
      what = 'largest effect over the poses';
      found.names = repeated(found.names(:), found.sizes);
    case 'identification'
      what = 'largest deformation by the error alone, SI';
    case 'sweep'
      what = 'figure of merit of the design';
    case 'calibration'
      what = 'estimate over its standard deviation';
    case 'evaluate'  % row: what a row of errors without a name is called
      what = 'largest magnitude over the poses';
      if isempty(found.names)
        found.names = arrayfun(@(k) sprintf('%s %d', found.row, k), (0:size(found.value, 1) - 1)', 'UniformOutput', false);
      end
  end
  if ~isfield(found, 'low')
    found.low = NaN(size(found.value));
    found.high = found.low;
  end
  smallest_first = false(1, size(found.value, 2));
  if isfield(found, 'from_best')  % values less that of the best row: positive where the smallest is the best
    smallest_first = any(found.from_best > 0, 1);
  end
  [scale, units] = poesy.internal.readable(found.units);
  scale = ones(size(found.value, 1), 1) * scale;
  table = struct('what', what, 'names', {found.names(:)}, 'responses', {found.responses(:)}, 'units', {units}, ...
                 'value', found.value .* scale, 'low', found.low .* scale, 'high', found.high .* scale, ...
                 'smallest_first', smallest_first);
end

function names = repeated(subsets, sizes)
  names = subsets;
  if sizes > 1
    each = arrayfun(@(k) strcat(subsets, sprintf(', size %d', k)), 1:sizes, 'UniformOutput', false);
    names = vertcat(each{:});
  end
end
