% What h5_values.py prints: a line that says the type, a line of reversed dimensions, then a value on each line.
function data = h5_values(file, object, attribute)
  script = fullfile(fileparts(mfilename('fullpath')), 'h5_values.py');
  [status, text] = system(sprintf('"%s" -B "%s" "%s" "%s" "%s" 2>&1', getenv('POESY_PYTHON'), script, file, object, ...
                                  attribute));
  if status ~= 0
    error('h5_values: %s', text);
  end
  lines = strsplit(text, "\n", "CollapseDelimiters", false);
  dimensions = [str2num(lines{2}), 1, 1];
  values = lines(3:2 + prod(dimensions))';
  if strcmp(lines{1}, 'number')
    values = str2double(values);
  end
  data = reshape(values, dimensions);
end
