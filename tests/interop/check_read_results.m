% Checks results/read_results.m, and with it how results/+poesy reads, on the examples of tests/engine/kinds/example_result.h:
% from exported tables as Octave reads them, and from the result file as MATLAB does, whose h5info, h5read and h5readatt are
% made up for in interop/matlab.
% usage: octave-cli check_read_results.m SOURCES EXAMPLES; POESY_PYTHON in the environment
1;

function fails(call, words)
  message = '';
  try
    call();
  catch problem
    message = problem.message;
  end
  assert(~isempty(message), ['no error; expected: ' words]);
  assert(~isempty(strfind(message, words)), [message ' does not say: ' words]);
end

function check_values(result)
  assert(result.factors, {'epsilon_1'; 'delta_1'});
  assert(result.factor_units, {'rad'; 'm'});
  assert(result.responses, {'angular_deformation'; 'linear_deformation'});
  assert(result.response_units, {'rad'; 'm'});
  assert(result.effect_units, {'deg'; 'mm'});
  assert(result.sigma, [0.5 / sqrt(3); 0.001], -1e-15);
  % Element (r, p) of array k is 1000 k + 100 r + 10 p, and the last of all is not known.
  assert(result.index, [11000 11100; 11010 NaN]);
  assert(result.index_low, [12000 12100; 12010 NaN]);
  assert(result.index_high, [13000 13100; 13010 NaN]);
  to_effect = [0.5 / sqrt(3); 0.001] * [180 / pi, 1000];
  assert(result.effect, [11000 11100; 11010 NaN] .* to_effect, -1e-15);
  assert(result.effect_low, [12000 12100; 12010 NaN] .* to_effect, -1e-15);
  assert(result.effect_high, [13000 13100; 13010 NaN] .* to_effect, -1e-15);
  assert(result.rank, [1 1; 2 2]);
end

function check_figure(source)
  figure_file = [tempname() '.svg'];
  read_results(source, 'angular_deformation', figure_file);
  drawn = fileread(figure_file);
  delete(figure_file);
  for words = {'<svg', 'global index x sigma \[deg\]', 'epsilon', 'delta', '</svg>'}
    assert(~isempty(regexp(drawn, words{1}, 'once')), ['the figure lacks ' words{1}]);
  end
  assert(numel(strfind(drawn, '<path')) > 5, 'the figure is empty');
end

% Folders of examples, and their kinds.
function list = kinds()
  list = {'monte_carlo', 'monte-carlo'; 'machines', 'monte-carlo'; 'evaluate', 'evaluate'; 'paired', 'evaluate'; ...
          'cases', 'evaluate'; 'identification', 'identification'; 'coupling', 'coupling'; 'allocation', 'allocation'; ...
          'sobol', 'sobol'};
end

% Every table of every kind: names, units and numbers are those of its text.
function check_tables(examples)
  for k = kinds()'
    folder = fullfile(examples, k{1});
    result = read_results(folder);
    assert(result.kind, k{2});
    files = dir(fullfile(folder, '*.csv'));
    assert(numel(fieldnames(result.tables)), numel(files));
    for file = {files.name}
      check_table(result.tables.(strrep(file{1}, '.csv', '')), fullfile(folder, file{1}));
    end
  end
end

function check_table(table, file)
  lines = strsplit(strtrim(fileread(file)), "\n");
  titles = strsplit(lines{1}, ',');
  last = strsplit(lines{end}, ',');
  assert(size(table.values), [numel(lines) - 1, numel(titles)]);
  assert(table.rows{end}, last{1});
  assert(table.cells(end, :), last);
  assert(table.values(end, :), str2double(last));
  for c = 1:numel(titles)
    title = table.columns{c};
    if ~strcmp(table.units{c}, '1')
      title = [title ' [' table.units{c} ']'];
    end
    assert(title, titles{c});
  end
end

% What is ranked is the same from a file and from its tables. From tables an evaluation has more columns.
function check_ranked(examples)
  for k = kinds()'
    from_file = read_results([fullfile(examples, k{1}) '.h5']);
    from_tables = read_results(fullfile(examples, k{1}));
    assert(from_file.kind, k{2});
    found = from_file.ranked;
    columns = 1:numel(found.responses);
    whole = from_tables.ranked;
    for name = {'responses', 'units', 'smallest_first'}
      whole.(name{1}) = whole.(name{1})(columns);
    end
    for name = {'value', 'low', 'high'}
      whole.(name{1}) = whole.(name{1})(:, columns);
    end
    assert(isequaln(found, whole), [k{1} ': tables and file rank different numbers']);
  end
end

% The groups of a file hold the numbers of its tables, and groups may lie in groups.
function check_groups(examples)
  from_file = read_results([fullfile(examples, 'monte_carlo') '.h5']);
  from_tables = read_results(fullfile(examples, 'monte_carlo'));
  assert(from_file.kind, 'monte-carlo');
  assert(from_file.groups.responses.name, {'angular_deformation'; 'linear_deformation'});
  poses = from_tables.tables.poses;
  assert(from_file.groups.poses.z(:), poses.values(:, strcmp(poses.columns, 'z')));
  table = from_tables.tables.monte_carlo_linear_deformation;
  assert(isequaln(from_file.groups.monte_carlo.mean(:, 2), table.values(:, strcmp(table.columns, 'mean'))));
  sobol = read_results([fullfile(examples, 'sobol') '.h5']).groups.sobol;
  table = read_results(fullfile(examples, 'sobol')).tables.sobol_linear_deformation;
  assert(isequaln(sobol.aggregated.ST(:, 2), table.values(:, strcmp(table.columns, 'ST'))));
end

warning('off', 'all');  % Octave's about its own fonts and gnuplot
arguments = argv();
sources = arguments{1};
examples = arguments{2};
addpath(fullfile(sources, 'results'));
assert(any(strcmp(available_graphics_toolkits(), 'gnuplot')), 'Octave cannot draw; install gnuplot-nox and fonts-freefont-otf');

tables = fullfile(examples, 'sensitivity');
file = [tables '.h5'];
from_tables = read_results(tables);
check_values(from_tables);
check_figure(tables);
fails(@() read_results(fullfile(examples, 'absent')), 'no such file or folder');
fails(@() read_results(examples), 'has the tables of 0 kinds of results');
fails(@() read_results(fullfile(examples, 'monte_carlo'), 'linear_deformation'), 'of kind monte-carlo, which has no indices');
check_tables(examples);
fails(@() read_results(tables, 'absent_response'), 'it has angular_deformation, linear_deformation');
setenv('POESY', fullfile(examples, 'absent'));
fails(@() read_results(file), 'poesy export');

addpath(fullfile(sources, 'tests', 'interop', 'matlab'));
from_file = read_results(file);
check_values(from_file);
assert(isequaln(from_file, from_tables), 'tables and file give different results');
fails(@() read_results([fullfile(examples, 'monte_carlo') '.h5'], 'linear_deformation'), 'of kind monte-carlo, which has no indices');
check_groups(examples);
check_ranked(examples);
fails(@() read_results(fullfile(tables, 'global.csv')), 'not a result of poesy');
fails(@() read_results(fullfile(examples, 'newer.h5')), 'has version 2.0, this reads 1.x');
fails(@() read_results(fullfile(examples, 'older.h5')), 'has version 0.9, this reads 1.x');
fails(@() read_results(fullfile(examples, 'stranger.h5')), 'filetype: something-else');
