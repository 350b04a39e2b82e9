% What h5_text.py prints of a file: a map from paths to values. Python is started once for a file.
function contents = h5_contents(file)
  persistent known
  if isempty(known)
    known = containers.Map();
  end
  if ~isKey(known, file)
    script = fullfile(fileparts(mfilename('fullpath')), 'h5_text.py');
    [status, text] = system(sprintf('"%s" -B "%s" "%s" 2>&1', getenv('POESY_PYTHON'), script, file));
    if status ~= 0
      error('h5_contents: %s', text);
    end
    known(file) = values_of(strsplit(text, "\n", 'CollapseDelimiters', false));
  end
  contents = known(file);
end

function contents = values_of(lines)
  contents = containers.Map();
  at = 1;
  while at < numel(lines)
    dimensions = [str2num(lines{at + 2}), 1, 1];
    values = lines(at + 3:at + 2 + prod(dimensions))';
    if strcmp(lines{at + 1}, 'number')
      values = str2double(values);
    else
      values = cellfun(@do_string_escapes, values, 'UniformOutput', false);
    end
    contents(lines{at}) = reshape(values, dimensions);
    at = at + 3 + prod(dimensions);
  end
end
