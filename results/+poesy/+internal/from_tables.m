function result = from_tables(folder)
% The folder of tables that `poesy export` wrote.
  result.kind = kind_of(folder);
  files = dir(fullfile(folder, '*.csv'));
  for file = {files.name}
    result.tables.(regexprep(file{1}, '\.csv$', '')) = read_table(fullfile(folder, file{1}));
  end
  if strcmp(result.kind, 'sensitivity')
    result.sensitivity = sensitivity_of(result.tables);
  end
  result.ranked = poesy.internal.ranked(result.kind, poesy.internal.quantities_of_tables(result));
end

% The kind of the result that a folder's tables belong to: by a table that no other kind has.
function kind = kind_of(folder)
  marks = {'global.csv', 'sensitivity'; 'overall.csv', 'monte-carlo'; 'evaluate.csv', 'evaluate'; ...
           'identification.csv', 'identification'; 'coupling.csv', 'coupling'; 'allocation.csv', 'allocation'; ...
           'sobol_*.csv', 'sobol'; 'sweep.csv', 'sweep'; 'estimates.csv', 'calibration'};
  there = cellfun(@(name) ~isempty(dir(fullfile(folder, name))), marks(:, 1));
  if sum(there) ~= 1
    error('poesy:tables', ['%s: has the tables of %d kinds of results; give the folder that ' ...
          '"poesy export RESULT.h5 -d FOLDER" made of one result'], folder, sum(there));
  end
  kind = marks{there, 2};
end

% A table of poesy: the first line names the columns with their units, the first column names the rows.
function table = read_table(file)
  lines = strsplit(strtrim(fileread(file)), char(10));
  cells = cellfun(@(line) strsplit(line, ','), lines, 'UniformOutput', false);
  cells = vertcat(cells{:});
  titles = cells(1, :)';
  names = regexprep(titles, ' \[.*\]$', '');
  units = regexprep(titles, '^.*\[(.*)\]$', '$1');  % "mean [m]" is in m; a title without brackets has the unit 1
  units(strcmp(names, titles)) = {'1'};
  table = struct('columns', {names}, 'units', {units}, 'rows', {cells(2:end, 1)}, 'cells', {cells(2:end, :)}, ...
                 'values', str2double(cells(2:end, :)));
end

function indices = sensitivity_of(tables)
  % factors.csv: sigma in SI and as people read it, 1000 times (mm) or 180 / pi times (deg) as much.
  sigma = tables.factors.values(:, 2:end);
  scale = sigma(:, 2) ./ sigma(:, 1);
  units = repmat({'1'}, numel(scale), 1);
  units(abs(scale / 1000 - 1) < 1e-6) = {'m'};
  units(abs(scale * pi / 180 - 1) < 1e-6) = {'rad'};
  % global.csv: for each response index, lower and upper end in SI, then the same three in mm or deg. The header says
  % "linear_deformation [m per m or rad]". After the published indices of all responses come the corrected ones, likewise.
  corrected = ~cellfun(@isempty, regexp(tables.global.columns, '_corrected(_ci_low|_ci_high)?$'));
  columns = strrep(tables.global.columns(corrected), '_corrected', '');
  index_units = tables.global.units(corrected);
  numbers = tables.global.values(:, corrected);
  indices = poesy.internal.indices(tables.factors.rows, units, sigma(:, 1), columns(1:6:end), ...
                                   regexprep(index_units(1:6:end), '^(\S+) per .*$', '$1'), numbers(:, 1:6:end), ...
                                   numbers(:, 2:6:end), numbers(:, 3:6:end));
end
