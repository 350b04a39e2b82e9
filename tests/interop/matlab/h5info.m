% MATLAB's h5info, for tests in Octave: the groups of the root with the names of their datasets, both as columns.
function info = h5info(file)
  script = fullfile(fileparts(mfilename('fullpath')), 'h5_info.py');
  [status, text] = system(sprintf('"%s" -B "%s" "%s" 2>&1', getenv('POESY_PYTHON'), script, file));
  if status ~= 0
    error('h5info: %s', text);
  end
  info.Groups = struct('Name', {}, 'Datasets', {});
  for line = strsplit(strtrim(text), "\n")
    words = strsplit(line{1}, ' ');
    info.Groups(end + 1, 1) = struct('Name', words{1}, 'Datasets', {struct('Name', words(2:end)')});
  end
end
