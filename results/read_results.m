function result = read_results(source, response, figure_file)
% READ_RESULTS  What a poesy study found, of any kind; the indices of a sensitivity study with names and intervals, ranked.
%
%   result = read_results('study.h5')     MATLAB reads the result file itself
%   result = read_results('tables')       Octave reads what `poesy export study.h5 -d tables` wrote; so can MATLAB
%   read_results(source)                  draws what each error of a sensitivity study does to the first response that is
%                                         a length (poesy show looks among those that the mechanism puts first; name it
%                                         to be sure)
%   read_results(source, 'angular_deformation')                          to another response
%   result = read_results(source, 'linear_deformation', 'ranked.svg')    writes the figure to a file
%
% result.kind is 'sensitivity', 'monte-carlo', 'evaluate', 'identification', 'coupling' or 'allocation'. Of a sensitivity
% study with P errors and R responses result also has
%   factors, factor_units            {P x 1}  names and SI units of the errors
%   responses, response_units        {R x 1}
%   sigma                            [P x 1]  standard deviation of each error, SI
%   index, index_low, index_high     [P x R]  global index and its interval, SI: response unit per factor unit; the
%                                             corrected one, or the published one where an older poesy wrote the result
%   effect, effect_low, effect_high  [P x R]  index x sigma, in effect_units {R x 1}: mm, deg
%   rank                             [P x R]  rank(k, r) is the error that has the k-th largest effect on response r
% Of any other kind it has, read from tables, result.tables.NAME for each NAME.csv:
%   columns, units                   {C x 1}  names of the columns, and their units ('1' for none)
%   rows                             {N x 1}  the first column as text: names of cases, numbers of poses, ...
%   values                           [N x C]  all cells as numbers, NaN where a cell is text
% and read from a file result.groups.GROUP.DATASET, as h5read gives them: axes in reversed order.
  if exist(source, 'dir') == 7
    result = from_tables(source);
  elseif exist(source, 'file') ~= 2
    error('read_results:absent', '%s: there is no such file or folder', source);
  elseif exist('h5read') == 0
    error('read_results:octave', ['%s: Octave does not read result files; run "poesy export %s -d tables" and give ' ...
          'read_results the folder tables'], source, source);
  else
    result = from_file(source);
  end
  if ~strcmp(result.kind, 'sensitivity')
    if nargin > 1 || nargout == 0
      error('read_results:kind', '%s: of kind %s, which has no indices to rank or draw; take result = read_results(''%s'')', ...
            source, result.kind, source);
    end
    return
  end
  if nargin < 2 || isempty(response)
    response = default_response(result);
  elseif ~any(strcmp(result.responses, response))
    error('read_results:response', '%s: there is no response %s; it has %s', source, response, ...
          strjoin(result.responses', ', '));
  end
  if nargin > 2
    f = figure('Visible', 'off');
    draw(result, response);
    saveas(f, figure_file);
    close(f);
  elseif nargout == 0
    figure();
    draw(result, response);
  end
end

function result = from_file(file)
  try
    filetype = char(h5readatt(file, '/', 'filetype'));
  catch
    filetype = 'none';
  end
  if ~strcmp(filetype, 'poesy-result')
    error('read_results:filetype', '%s: not a result of poesy (attribute filetype: %s)', file, filetype);
  end
  version = h5readatt(file, '/', 'version');
  if version(1) > 1
    error('read_results:version', '%s: has version %d.%d, this reads 1.x; take the newer read_results.m', file, ...
          version(1), version(2));
  end
  kind = char(h5readatt(file, '/', 'kind'));
  if ~strcmp(kind, 'sensitivity')
    result.kind = kind;
    result.groups = groups_of(file);
    return
  end
  index = '/sensitivity/global_corrected';
  try
    h5read(file, index);
  catch
    index = '/sensitivity/global';  % an older poesy wrote the file
  end
  % h5read gives the axes in reversed order: what the file has as [R x P] arrives as [P x R]. Names arrive as a string
  % array or, in older versions, as a cell array; cellstr takes both.
  result = assembled(cellstr(h5read(file, '/factors/name')), cellstr(h5read(file, '/factors/unit')), ...
                     h5read(file, '/factors/sigma'), ...
                     cellstr(h5read(file, '/responses/name')), cellstr(h5read(file, '/responses/unit')), ...
                     h5read(file, index), h5read(file, [index '_ci_low']), h5read(file, [index '_ci_high']));
end

% Every dataset of every group.
function groups = groups_of(file)
  info = h5info(file);
  for group = info.Groups'
    for dataset = group.Datasets'
      path = [group.Name '/' dataset.Name];
      values = h5read(file, path);
      if ~isnumeric(values)
        values = cellstr(values);
      end
      groups.(group.Name(2:end)).(dataset.Name) = values;
    end
  end
end

% The kind of the result that a folder's tables belong to: by a table that no other kind has.
function kind = kind_of(folder)
  marks = {'global.csv', 'sensitivity'; 'overall.csv', 'monte-carlo'; 'evaluate.csv', 'evaluate'; ...
           'identification.csv', 'identification'; 'coupling.csv', 'coupling'; 'allocation.csv', 'allocation'};
  there = cellfun(@(name) exist(fullfile(folder, name), 'file') == 2, marks(:, 1));
  if sum(there) ~= 1
    error('read_results:tables', ['%s: has the tables of %d kinds of results; give the folder that ' ...
          '"poesy export RESULT.h5 -d FOLDER" made of one result'], folder, sum(there));
  end
  kind = marks{there, 2};
end

function tables = all_tables(folder)
  files = dir(fullfile(folder, '*.csv'));
  for file = {files.name}
    [rows, columns, numbers] = read_table(fullfile(folder, file{1}));
    name = regexprep(file{1}, '\.csv$', '');
    [units, names] = units_of(columns);
    tables.(name) = struct('columns', {names}, 'units', {units}, 'rows', {rows}, 'values', numbers);
  end
end

% "mean [m]" is in m; a title without brackets has the unit 1.
function [units, names] = units_of(titles)
  names = regexprep(titles, ' \[.*\]$', '');
  units = regexprep(titles, '^.*\[(.*)\]$', '$1');
  units(strcmp(names, titles)) = {'1'};
end

function result = from_tables(folder)
  kind = kind_of(folder);
  if ~strcmp(kind, 'sensitivity')
    result.kind = kind;
    result.tables = all_tables(folder);
    return
  end
  % factors.csv: sigma in SI and as people read it, 1000 times (mm) or 180 / pi times (deg) as much.
  [factors, ~, sigma] = read_table(fullfile(folder, 'factors.csv'));
  sigma = sigma(:, 2:end);
  scale = sigma(:, 2) ./ sigma(:, 1);
  factor_units = repmat({'1'}, numel(factors), 1);
  factor_units(abs(scale / 1000 - 1) < 1e-6) = {'m'};
  factor_units(abs(scale * pi / 180 - 1) < 1e-6) = {'rad'};
  % global.csv: for each response index, lower and upper end in SI, then the same three in mm or deg. The header says
  % "linear_deformation [m per m or rad]". After the published indices of all responses come the corrected ones, likewise.
  [~, columns, numbers] = read_table(fullfile(folder, 'global.csv'));
  columns = columns(2:end);
  numbers = numbers(:, 2:end);
  corrected = ~cellfun(@isempty, regexp(columns, '_corrected(_ci_low|_ci_high)? '));
  if any(corrected)
    columns = strrep(columns(corrected), '_corrected', '');
    numbers = numbers(:, corrected);
  end
  first = columns(1:6:end);
  responses = regexprep(first, ' \[.*', '');
  response_units = regexprep(first, '^.*\[(\S+) per .*$', '$1');
  result = assembled(factors, factor_units, sigma(:, 1), responses, response_units, numbers(:, 1:6:end), ...
                     numbers(:, 2:6:end), numbers(:, 3:6:end));
end

% A table of poesy: the first line names the columns, the first column the rows. numbers has NaN where a cell is text.
function [rows, columns, numbers] = read_table(file)
  lines = strsplit(strtrim(fileread(file)), char(10));
  cells = cellfun(@(line) strsplit(line, ','), lines, 'UniformOutput', false);
  cells = vertcat(cells{:});
  rows = cells(2:end, 1);
  columns = cells(1, :)';
  numbers = str2double(cells(2:end, :));
end

function result = assembled(factors, factor_units, sigma, responses, response_units, index, low, high)
  result.kind = 'sensitivity';
  result.factors = factors(:);
  result.factor_units = factor_units(:);
  result.responses = responses(:);
  result.response_units = response_units(:);
  result.sigma = sigma(:);
  result.index = index;
  result.index_low = low;
  result.index_high = high;
  effect_units = result.response_units;
  scale = ones(1, numel(effect_units));
  scale(strcmp(effect_units, 'm')) = 1000;
  scale(strcmp(effect_units, 'rad')) = 180 / pi;
  effect_units(strcmp(effect_units, 'm')) = {'mm'};
  effect_units(strcmp(effect_units, 'rad')) = {'deg'};
  result.effect_units = effect_units;
  to_effect = result.sigma * scale;
  result.effect = index .* to_effect;
  result.effect_low = low .* to_effect;
  result.effect_high = high .* to_effect;
  spread = result.effect;
  spread(isnan(spread)) = -1;  % an index that is not known ranks last
  [~, result.rank] = sort(spread, 1, 'descend');
end

function response = default_response(result)
  choices = [find(strcmp(result.response_units, 'm')); 1];
  response = result.responses{choices(1)};
end

function draw(result, response)
  r = find(strcmp(result.responses, response));
  order = result.rank(:, r);
  rows = 1:numel(order);
  barh(rows, result.effect(order, r));
  hold('on');
  plot([result.effect_low(order, r), result.effect_high(order, r)]', [rows; rows], 'k-');
  hold('off');
  set(gca(), 'YDir', 'reverse', 'YTick', rows, 'TickLabelInterpreter', 'none');
  set(gca(), 'YTickLabel', result.factors(order));
  xlabel(['global index x sigma [' result.effect_units{r} ']']);
  title(response, 'Interpreter', 'none');
end
