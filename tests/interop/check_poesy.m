% Checks results/+poesy on studies of every kind, which it runs: numbers are those that `poesy export` writes, rankings are in
% order, figures are drawn, and errors carry the program's sentence.
% usage: octave-cli check_poesy.m SOURCES; POESY, the program, in the environment
1;

function said = program(varargin)
  [code, said] = system(strjoin([{['"' getenv('POESY') '"']}, varargin], ' '));
  assert(code == 0, said);
end

function fails(call, identifier, words)
  problem = struct('identifier', 'none', 'message', 'no error');
  try
    call();
  catch problem
  end
  assert(strcmp(problem.identifier, identifier), [problem.identifier ': ' problem.message]);
  assert(~isempty(strfind(problem.message, words)), [problem.message ' does not say: ' words]);
end

function write(file, text)
  f = fopen(file, 'w');
  fputs(f, text);
  fclose(f);
end

% The program's own template of the kind, with few poses and samples.
function file = small_study(kind)
  model = '2upr-rpu';
  if strcmp(kind, 'coupling')
    model = '3-prs';  % the other suggests no sources of errors
  end
  text = regexprep(program('template', model, kind), '^count = \d+', 'count = 3', 'lineanchors');
  text = regexprep(text, '^samples = \d+', 'samples = 100', 'lineanchors');
  file = [strrep(kind, '-', '_') '.toml'];
  write(file, text);
end

% Every cell of every table that the program exports is in result.tables.
function check_tables(result)
  program('export', result.file, '-d', 'exported');
  files = dir(fullfile('exported', '*.csv'));
  assert(numel(fieldnames(result.tables)), numel(files));
  for file = {files.name}
    lines = strsplit(strtrim(fileread(fullfile('exported', file{1}))), "\n");
    table = result.tables.(strrep(file{1}, '.csv', ''));
    joined = cellfun(@(row) strjoin(table.cells(row, :), ','), num2cell(1:rows(table.cells)), 'UniformOutput', false);
    assert(isequal(joined, lines(2:end)), file{1});
    if numel(lines) > 1
      assert(table.values(end, :), str2double(strsplit(lines{end}, ',')));
    end
  end
  poesy.internal.remove_folder('exported');
end

% Numbers that are ranked, in units that people read, beside the cell of the table where the program has them.
function check_against_table(result, response, table, column, scale)
  from = result.tables.(table);
  ranked = poesy.ranking(result, response);
  expected = from.values(ranked.order, strcmp(from.columns, column)) * scale;
  assert(ranked.value, expected, -1e-14);
  assert(ranked.names, from.rows(ranked.order));
end

function check_ranking(result)
  found = result.ranked;
  for r = 1:numel(found.responses)
    ranked = poesy.ranking(result, found.responses{r});
    known = ranked.value(~isnan(ranked.value));
    assert(numel(known) > 0, [result.kind ': nothing is ranked']);
    if ~found.smallest_first(r)
      known = -known;
    end
    assert(issorted(known), [result.kind ' is not in order']);
    assert(all(isnan(ranked.value(numel(known) + 1:end))));
    assert(sort(ranked.order), (1:numel(found.names))');
    assert(ranked.unit, found.units{r});
  end
  printed = evalc('poesy.ranking(result);');
  assert(numel(strsplit(strtrim(printed), "\n")), numel(found.names) + 1);
end

function check_figure(result)
  poesy.plot(result, '', 'ranked.svg');
  drawn = fileread('ranked.svg');
  delete('ranked.svg');
  title = strrep(result.ranked.what, ' x sigma', '');
  for words = {'<svg', title, result.ranked.names{1}, '</svg>'}
    assert(~isempty(strfind(drawn, words{1})), [result.kind ': the figure lacks ' words{1}]);
  end
  assert(numel(strfind(drawn, '<path')) > 5, [result.kind ': the figure is empty']);
end

function check_sensitivity(result)
  shown = program('show', result.file, '--response', 'angular_deformation');
  names = regexp(shown, '^ *\d+  (\w+) ', 'tokens', 'lineanchors');
  names = cellfun(@(token) token{1}, names, 'UniformOutput', false);
  assert(numel(names) > 9, shown);
  ranked = poesy.ranking(result.file, 'angular_deformation');
  assert(ranked.names(1:numel(names))', names);
  first = poesy.ranking(result);
  assert({first.response, first.unit}, {'gap', 'mm'});
  assert(ranked.value, result.sensitivity.effect(ranked.order, strcmp(result.ranked.responses, 'angular_deformation')), -1e-14);
end

function check_kind(kind)
  result = poesy.run(small_study(kind), '--threads', 2);
  assert(result.kind, kind);
  assert(result.file, [strrep(kind, '-', '_') '.h5']);
  assert(result.exit_code, 0);
  check_tables(result);
  check_ranking(result);
  check_figure(result);
  switch kind
    case 'sensitivity'
      check_sensitivity(result);
    case 'monte-carlo'
      check_against_table(result, 'linear_deformation', 'S1', 'S1_linear_deformation', 1);
    case 'sobol'
      check_against_table(result, 'linear_deformation', 'sobol_linear_deformation', 'ST', 1);
    case 'allocation'
      check_against_table(result, 'all', 'allocation', 'share', 1);
    case 'identification'
      check_against_table(result, result.tables.groups.rows{1}, 'single_max', 'group_1', 1);
    case 'evaluate'
      response = result.tables.cases.columns{end}(1:end - 8);
      check_against_table(result, response, 'cases', [response '_extreme'], 1000 ^ strcmp(result.tables.cases.units{end}, 'm'));
  end
end

% Figures of merit of the designs of a sweep.
function check_sweep()
  study = regexprep(fileread(small_study('monte-carlo')), '^draws = .*$', 'draws = "per machine"', 'lineanchors', ...
                    'dotexceptnewline');
  write('machines.toml', [study "\n[analysis.limits]\nlinear_deformation = \"0.2 mm\"\n"]);
  program('sweep', 'machines.toml', '--set', '"errors.linear.sigma=1,2,3mm"', '-o', 'sweep.h5', '--quiet');
  result = poesy.read('sweep.h5');
  result.file = 'sweep.h5';
  assert(result.kind, 'sweep');
  assert(result.ranked.names, {'sigma = 1 mm'; 'sigma = 2 mm'; 'sigma = 3 mm'});
  assert(result.ranked.responses{1}, 'yield');
  assert(result.ranked.units{1}, '%');
  check_tables(result);
  check_ranking(result);
  check_figure(result);
  check_against_table(result, 'yield', 'sweep', 'yield', 1);
  first = poesy.ranking(result);
  assert({first.response, first.unit}, {'yield', '%'});
  assert(first.names{1}, 'sigma = 1 mm');
  is_scatter = strcmp(result.ranked.units(:), 'mm');  % the root mean square, of which the smallest is the best
  assert(any(is_scatter));
  assert(result.ranked.smallest_first(:), is_scatter);
  scatter = poesy.ranking(result, result.ranked.responses{find(is_scatter, 1)});
  assert(scatter.names{1}, 'sigma = 1 mm');
  ranked = poesy.ranking(result, 'yield');
  assert(all(ranked.low <= ranked.value & ranked.value <= ranked.high));
end

% The fitted errors of a calibration.
function check_calibration(data)
  copyfile(fullfile(data, 'delta-*'), '.');
  program('calibrate', 'delta-measured.toml', '--measured', 'delta-heights.csv', '-o', 'calibration.h5');
  result = poesy.read('calibration.h5');
  result.file = 'calibration.h5';
  assert(result.kind, 'calibration');
  check_tables(result);
  check_ranking(result);
  check_figure(result);
  fitted = result.tables.estimates;
  assert(result.ranked.names, fitted.rows);
  number = @(name) fitted.values(:, strcmp(fitted.columns, name));
  assert(result.ranked.value, abs(number('estimate')) ./ number('sd'), -1e-14);
end

% An error without effect has the effect 0 and the interval 0 to 0, as poesy show prints it.
function check_no_effect()
  index = [7.9e-14 1; 3 2];
  indices = poesy.internal.indices({'a'; 'b'}, {'m'; 'm'}, [1e-4; 1e-4], {'gap'; 'position'}, {'m'; 'm'}, index, 0.9 * index, ...
                                   1.1 * index);
  found = poesy.internal.effects(indices);
  assert([found.value(1, 1), found.low(1, 1), found.high(1, 1)], [0 0 0]);
  assert(found.value(2, 1), 3e-4, -1e-14);
end

% The gap of a planar mechanism: what its indices say is the rounding of solves.
function check_what_does_not_vary()
  index = [1e-13 1; 3e-13 2];
  indices = poesy.internal.indices({'a'; 'b'}, {'m'; 'm'}, [1e-4; 1e-4], {'gap'; 'position'}, {'m'; 'm'}, index, index, index);
  result = struct('kind', 'sensitivity', 'ranked', poesy.internal.ranked('sensitivity', poesy.internal.effects(indices)));
  first = poesy.ranking(result);
  assert(first.response, 'position');
  assert(first.names, {'b'; 'a'});
  gap = poesy.ranking(result, 'gap');
  assert(all(isnan(gap.value)));
end

% Limits that are not kept: the result is there, and a warning that can be turned off says so.
function check_limits()
  write('limits.toml', [program('template', '2upr-rpu', 'evaluate'), ...
                        "\n[analysis.limits]\nlinear_deformation = \"1 um\"\n"]);
  warning('on', 'poesy:exit6');
  lastwarn('');
  result = poesy.run('limits.toml', '--output=kept.h5');
  [said, identifier] = lastwarn();
  assert(identifier, 'poesy:exit6');
  assert(strncmp(said, 'limits.toml: linear_deformation is ', 35), said);
  assert({result.exit_code, result.file}, {6, 'kept.h5'});
  assert(isequaln(rmfield(result, {'file', 'exit_code'}), poesy.read('kept.h5')));
end

function check_errors()
  write('bad.toml', strrep(program('template', '2upr-rpu'), '"1 deg"', '"1 degg"'));
  fails(@() poesy.run('bad.toml'), 'poesy:exit2', 'unknown unit ''degg''');
  fails(@() poesy.run('absent.toml'), 'poesy:exit3', 'absent.toml');
  fails(@() poesy.run('sensitivity.toml', '--threads', 'many'), 'poesy:exit2', '--threads');
  fails(@() poesy.read('absent.h5'), 'poesy:absent', 'no such file or folder');
  fails(@() poesy.read('bad.toml'), 'poesy:exit3', 'bad.toml');
  fails(@() poesy.ranking('sensitivity.h5', 'absent'), 'poesy:response', 'it has');
  there = getenv('POESY');
  setenv('POESY', fullfile(pwd(), 'not poesy'));
  fails(@() poesy.run('sensitivity.toml'), 'poesy:program', 'the program is not there');
  setenv('POESY', there);
end

warning('off', 'all');  % Octave's about its own fonts and gnuplot
addpath(fullfile(argv(){1}, 'results'));
folder = fullfile(tempname(), 'it''s a folder');
mkdir(folder);
removed = onCleanup(@() poesy.internal.remove_folder(fileparts(folder)));
cd(folder);
for kind = {'sensitivity', 'identification', 'evaluate', 'monte-carlo', 'sobol', 'allocation', 'coupling'}
  check_kind(kind{1});
end
check_sweep();
check_calibration(fullfile(argv(){1}, 'tests', 'data', 'calibration'));
check_no_effect();
check_what_does_not_vary();
check_limits();
check_errors();
cd('/');
