function found = quantities_of_groups(result)
% What POESY.INTERNAL.RANKED takes, from the groups of a result file: what the file has as [R x N] is [N x R] here.
  groups = result.groups;
  responses = groups.responses.name;
  none = repmat({'1'}, numel(responses), 1);
  switch result.kind
    case 'sensitivity'
      found = poesy.internal.effects(result.sensitivity);
    case 'monte-carlo'
      found = intervals(groups.monte_carlo, 'S1', struct('names', {groups.factors.name}, 'responses', {responses}, ...
                                                         'units', {none}));
    case 'sobol'
      found = total_indices(groups.sobol.aggregated, responses, none);
    case 'allocation'
      parts = groups.allocation;
      found = struct('names', {parts.part}, 'responses', {{'all'}}, 'units', {{'1'}}, 'value', parts.share(:), ...
                     'mean_square_share', parts.mean_square_share(:));
    case 'coupling'
      coupling = groups.coupling;
      found = struct('names', {coupling.subset}, 'sizes', numel(coupling.size), 'responses', {responses}, ...
                     'units', {groups.responses.unit}, 'value', reshape(coupling.effect_max, [], numel(responses)));
    case 'identification'
      group = groups.identification.group;
      found = struct('names', {groups.factors.name}, 'responses', {group}, 'units', {repmat({'1'}, numel(group), 1)}, ...
                     'value', groups.identification.single_max);
    case 'evaluate'
      found = outcomes(groups);
    case 'sweep'
      sweep = groups.sweep;
      found = struct('names', {designs(sweep)}, 'responses', {sweep.quantity}, 'units', {sweep.quantity_unit}, ...
                     'value', sweep.merit, 'low', sweep.low, 'high', sweep.high, 'from_best', sweep.from_best);
    case 'calibration'
      fit = groups.calibration;
      found = struct('names', {fit.fitted}, 'responses', {{'all'}}, 'units', {{'1'}}, 'value', abs(fit.estimate(:)) ./ fit.sd(:));
  end
end

function found = intervals(group, name, found)
  found.value = group.(name);
  found.low = group.([name '_ci_low']);
  found.high = group.([name '_ci_high']);
end

% In the order in which a folder has the tables.
function found = total_indices(group, responses, none)
  names = 'factor';
  if isfield(group, 'group')
    names = 'group';
  end
  [responses, order] = sort(responses(:));
  found = intervals(group, 'ST', struct('names', {group.(names)}, 'responses', {responses}, 'units', {none}));
  found.value = found.value(:, order);
  found.low = found.low(:, order);
  found.high = found.high(:, order);
end

% Outcomes are [rows x poses], of cases [poses x cases]. Rows that are paired with poses one by one are [1 x poses].
function found = outcomes(groups)
  outcome = groups.evaluate;
  along = 2;
  found = struct('names', {{}}, 'row', 'sample');
  if isfield(outcome, 'case')
    found.names = outcome.case;
    along = 1;
  elseif isfield(groups.errors, 'pose')
    found.row = 'pose';
    along = 3;
  end
  if isfield(outcome, 'label')
    found.names = outcome.label;
  end
  found.responses = groups.responses.name;
  found.units = groups.responses.unit;
  each = @(name) reshape(max(abs(outcome.(name)), [], along), [], 1);
  found.value = cell2mat(cellfun(each, found.responses(:)', 'UniformOutput', false));
end

% Names of designs as the tables have them: "R = 100 mm, L = 200 mm".
function names = designs(sweep)
  keys = regexprep(sweep.key(:), '^.*\.', '');
  alike = cellfun(@(key) sum(strcmp(keys, key)) > 1, keys);
  keys(alike) = sweep.key(alike);
  values = reshape(sweep.value, numel(keys), []);
  each = @(d) strjoin(cellfun(@(key, value) [key ' = ' value], keys, values(:, d), 'UniformOutput', false)', ', ');
  names = arrayfun(each, (1:size(values, 2))', 'UniformOutput', false);
end
