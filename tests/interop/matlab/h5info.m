% MATLAB's h5info, for tests in Octave: the groups of the root with their datasets and the groups within, as columns.
function info = h5info(file)
  paths = keys(h5_contents(file));
  info = group_of(paths(~strncmp(paths, '/@', 2)), '');
end

function group = group_of(paths, name)
  words = cellfun(@(path) strsplit(path(numel(name) + 2:end), '/'), paths, 'UniformOutput', false);
  deeper = cellfun(@numel, words) > 1;
  first = cellfun(@(of) of{1}, words, 'UniformOutput', false);
  group.Name = name;
  group.Datasets = struct('Name', first(~deeper)');
  group.Groups = struct('Name', {}, 'Datasets', {}, 'Groups', {});
  for inner = unique(first(deeper))
    path = [name '/' inner{1}];
    group.Groups(end + 1, 1) = group_of(paths(strncmp(paths, [path '/'], numel(path) + 1)), path);
  end
end
