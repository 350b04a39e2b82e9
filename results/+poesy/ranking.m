function ranked = ranking(result, response)
% POESY.RANKING  What matters most: the rows of result.ranked for one response, the largest first; of a sweep the best.
%
%   poesy.ranking(result)                          prints the ranking for the response that the study is about
%   poesy.ranking(result, 'angular_deformation')   for another response
%   ranked = poesy.ranking(result, response)       gives it: kind, what, response, unit; names {N x 1};
%                                                  value, low, high [N x 1]; order [N x 1], the rows of result.ranked
%
% result is what POESY.READ or POESY.RUN gave, or a file or folder that POESY.READ takes. See there for what is ranked. Rows
% without a number come last, and rows with the same number in the order of the result. Without a name it is a response with a
% limit, the one whose limit is missed most often; without limits the displacement of the tool, without a tool that of the
% platform; else the first length, or the first that has a number: one that does not vary has no shares.
% Of a sweep it is the first figure of merit.
  if ~isstruct(result)
    result = poesy.read(result);
  end
  all = result.ranked;
  if nargin < 2 || isempty(response)
    known = reshape(any(~isnan(all.value), 1), [], 1);  % a response that does not vary has no share
    first = [];
    for name = reshape(poesy.internal.leading(result), 1, [])
      first = [first; find(strcmp(all.responses(:), name{1}) & known)];  %#ok<AGROW> a few names
    end
    if ~strcmp(result.kind, 'sweep')
      first = [first; find(strcmp(all.units(:), 'mm') & known)];
    end
    first = [first; find(known); 1];
    response = all.responses{first(1)};
  end
  r = find(strcmp(all.responses, response));
  if isempty(r)
    error('poesy:response', 'there is no response %s; it has %s', response, strjoin(all.responses', ', '));
  end
  sorted = all.value(:, r);
  if all.smallest_first(r)
    sorted = -sorted;
  end
  sorted(isnan(sorted)) = -Inf;
  [~, order] = sort(sorted, 'descend');
  ranked = struct('kind', result.kind, 'what', all.what, 'response', response, 'unit', all.units{r}, ...
                  'names', {all.names(order)}, 'value', all.value(order, r), 'low', all.low(order, r), ...
                  'high', all.high(order, r), 'order', order);
  if nargout == 0
    print(ranked);
    clear('ranked');
  end
end

function print(ranked)
  width = max(cellfun(@numel, ranked.names));
  fprintf('%s [%s], %s\n', ranked.what, ranked.unit, ranked.response);
  for k = 1:numel(ranked.names)
    fprintf('%4d  %-*s  %12.4g', k, width, ranked.names{k}, ranked.value(k));
    if ~isnan(ranked.low(k))
      fprintf('  (%.4g to %.4g)', ranked.low(k), ranked.high(k));
    end
    fprintf('\n');
  end
end
