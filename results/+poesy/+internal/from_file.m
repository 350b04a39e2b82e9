function result = from_file(file)
% A result file as MATLAB's h5read gives it. h5read follows links and external storage into other files: of a file that
% somebody else sent, ask `poesy verify` first, which refuses it then.
  try
    filetype = char(h5readatt(file, '/', 'filetype'));
  catch
    filetype = 'none';
  end
  if ~strcmp(filetype, 'poesy-result')
    error('poesy:filetype', '%s: not a result of poesy (attribute filetype: %s)', file, filetype);
  end
  version = h5readatt(file, '/', 'version');
  if version(1) ~= 1
    error('poesy:version', '%s: has version %d.%d, this reads 1.x; take the +poesy of that version', file, version(1), ...
          version(2));
  end
  result.kind = char(h5readatt(file, '/', 'kind'));
  info = h5info(file);
  result.groups = children(file, info.Groups);
  if strcmp(result.kind, 'sensitivity')
    result.sensitivity = sensitivity_of(result.groups);
  end
  result.ranked = poesy.internal.ranked(result.kind, poesy.internal.quantities_of_groups(result));
end

% Every dataset of every group, and the groups within.
function all = children(file, groups)
  all = struct();
  for k = 1:numel(groups)
    group = groups(k);
    here = children(file, group.Groups);
    for d = 1:numel(group.Datasets)
      name = group.Datasets(d).Name;
      values = h5read(file, [group.Name '/' name]);
      if ~isnumeric(values)
        values = cellstr(values);  % a string array or, in older versions of MATLAB, already a cell array
      end
      here.(name) = values;
    end
    all.(regexprep(group.Name, '^.*/', '')) = here;
  end
end

% h5read gives the axes in reversed order: what the file has as [R x P] arrives as [P x R].
function indices = sensitivity_of(groups)
  found = groups.sensitivity;
  indices = poesy.internal.indices(groups.factors.name, groups.factors.unit, groups.factors.sigma, groups.responses.name, ...
                                   groups.responses.unit, found.global_corrected, found.global_corrected_ci_low, ...
                                   found.global_corrected_ci_high);
end
