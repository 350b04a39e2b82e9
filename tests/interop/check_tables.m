% Loads every exported table of a folder with one line, importdata, and checks its size and names against the plain text.
% usage: octave-cli check_tables.m FOLDER
1;

function check_table(path)
  t = importdata(path, ',', 1);

  lines = strsplit(strtrim(fileread(path)), "\n");
  columns = numel(strsplit(lines{1}, ','));
  first = cellfun(@(line) strtok(line, ','), lines(2:end), 'UniformOutput', false);
  named = any(isnan(str2double(first)));
  assert(isstruct(t), [path ': importdata gives no table']);
  assert(size(t.data), [numel(lines) - 1, columns - named]);
  if (named)
    assert(t.rowheaders(:), first(:));
  else
    assert(t.data(:, 1), str2double(first(:)));
    assert(numel(t.colheaders), columns);
  end
  last = strsplit(lines{end}, ',');
  expected = str2double(last{end});
  assert(isnan(t.data(end, end)), isnan(expected));  % a unit is not a number
  if (!isnan(expected))
    assert(t.data(end, end), expected);
  end
end

folder = argv(){1};
tables = glob(fullfile(folder, '*.csv'));
assert(numel(tables) >= 4, 'too few tables');
for k = 1:numel(tables)
  check_table(tables{k});
end
