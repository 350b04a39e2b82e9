function found = quantities_of_tables(result)
% What POESY.INTERNAL.RANKED takes, from a result's tables.
  tables = result.tables;
  switch result.kind
    case 'sensitivity'
      found = poesy.internal.effects(result.sensitivity);
    case 'monte-carlo'
      found = first_order(tables);
    case 'sobol'
      found = total_indices(tables);
    case 'allocation'
      parts = tables.allocation;
      found = struct('names', {parts.rows}, 'responses', {{'all'}}, 'units', {{'1'}}, 'value', column(parts, 'share'), ...
                     'mean_square_share', column(parts, 'mean_square_share'));
    case 'coupling'
      found = subsets(tables.coupling_summary);
    case 'identification'
      groups = tables.groups.rows;
      found = struct('names', {tables.single_max.rows}, 'responses', {groups}, 'units', {repmat({'1'}, numel(groups), 1)}, ...
                     'value', tables.single_max.values(:, 2:end));
    case 'evaluate'
      found = outcomes(tables);
    case 'sweep'
      found = merits(tables.sweep);
    case 'calibration'
      fitted = tables.estimates;
      found = struct('names', {fitted.rows}, 'responses', {{'all'}}, 'units', {{'1'}}, ...
                     'value', abs(column(fitted, 'estimate')) ./ column(fitted, 'sd'));
  end
end

function numbers = column(table, name)
  numbers = table.values(:, strcmp(table.columns, name));
end

% S1.csv: the index of each response, and the ends of its interval.
function found = first_order(tables)
  s1 = tables.S1;
  responses = regexprep(s1.columns(2:3:end), '^S1_', '');
  found = struct('names', {s1.rows}, 'responses', {responses}, 'units', {repmat({'1'}, numel(responses), 1)}, ...
                 'value', s1.values(:, 2:3:end), 'low', s1.values(:, 3:3:end), 'high', s1.values(:, 4:3:end));
end

% A table for each response, beside tables of poses, pairs and vectors.
function found = total_indices(tables)
  names = fieldnames(tables);
  names = sort(names(~cellfun(@isempty, regexp(names, '^sobol_(?!S1_|ST_|pairs_|vector_)'))));
  each = @(which) cell2mat(cellfun(@(name) column(tables.(name), which), names', 'UniformOutput', false));
  found = struct('names', {tables.(names{1}).rows}, 'responses', {regexprep(names, '^sobol_', '')}, ...
                 'units', {repmat({'1'}, numel(names), 1)}, 'value', each('ST'), 'low', each('ST_ci_low'), ...
                 'high', each('ST_ci_high'));
end

% A line for each subset at each size, all subsets at the first size first.
function found = subsets(summary)
  at = find(~cellfun(@isempty, regexp(summary.columns, '_effect_max$')));
  sizes = sum(strcmp(summary.rows, summary.rows{1}));
  found = struct('names', {summary.rows(1:end / sizes)}, 'sizes', sizes, ...
                 'responses', {regexprep(summary.columns(at), '_effect_max$', '')}, 'units', {summary.units(at)}, ...
                 'value', summary.values(:, at));
end

% A line for each design: figures of merit with intervals, in units that people read.
function found = merits(designs)
  names = regexprep(designs.columns(~cellfun(@isempty, regexp(designs.columns, ' change low$'))), ' change low$', '');
  each = @(ending) cell2mat(cellfun(@(name) column(designs, [name ending]), names', 'UniformOutput', false));
  units = cellfun(@(name) designs.units(strcmp(designs.columns, name)), names);
  found = struct('names', {designs.rows}, 'responses', {names}, 'units', {units}, 'value', each(''), 'low', each(' low'), ...
                 'high', each(' high'), 'from_best', each(' from best'));
end

% A line for each pose and row of errors: case by case, else pose by pose. Rows may be paired with poses one by one.
function found = outcomes(tables)
  lines = tables.evaluate;
  named = tables.errors.columns{1};
  found = struct('names', {tables.errors.rows}, 'row', 'sample');
  count = numel(found.names);
  if strcmp(named, 'case')
    row = ceil((1:numel(lines.rows))' * count / numel(lines.rows));
  else
    if any(strcmp(tables.errors.columns, 'pose'))
      found.row = 'pose';
    end
    row = column(lines, found.row) + 1;
    if strcmp(named, found.row)
      found.names = {};
    end
  end
  at = find(~ismember(lines.columns, {named, 'pose', 'sample', 'time', 'status', 'iterations'}));
  found.responses = lines.columns(at);
  found.units = lines.units(at);
  found.value = NaN(count, numel(at));
  for r = 1:numel(at)
    found.value(:, r) = accumarray(row, abs(lines.values(:, at(r))), [count, 1], @max, NaN);
  end
end
