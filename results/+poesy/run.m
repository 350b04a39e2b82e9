function result = run(study, varargin)
% POESY.RUN  Runs a study with the program poesy, and reads what it found as POESY.READ does.
%
%   result = poesy.run('study.toml')                            writes study.h5 in this folder
%   result = poesy.run('study.toml', '-o', 'mine.h5')           further arguments are those of `poesy run`
%   result = poesy.run('study.toml', '--threads', 4, '--seed', 7)
%
% result.file is the result file. result.exit_code is 0; 5 where more samples failed to converge than the study allows, and
% 6 where a limit of the study is not kept: the result is there then, and a warning (poesy:exit5, poesy:exit6) says so.
% Anything else that ends the program is an error with the program's own sentence and the identifier poesy:exitN.
%
% The program is looked for as the environment variable POESY says, then in the path: setenv('POESY', '/path/to/poesy').
  study = char(study);
  options = cellfun(@text, varargin, 'UniformOutput', false);
  [~, name] = fileparts(study);
  file = [name '.h5'];
  at = find(strcmp(options, '-o') | strcmp(options, '--output'), 1);
  joined = find(strncmp(options, '--output=', 9), 1);
  if ~isempty(joined)
    file = options{joined}(10:end);
  elseif isempty(at)
    options = [options, {'-o', file}];
  elseif at < numel(options)
    file = options{at + 1};
  end
  [said, code] = poesy.internal.program([{'run', study, '--quiet'}, options], [5 6]);
  if code ~= 0
    warning(sprintf('poesy:exit%d', code), '%s', poesy.internal.sentence(said));
  end
  result = poesy.read(file);
  result.file = file;
  result.exit_code = code;
end

function word = text(argument)
  if isnumeric(argument)
    word = sprintf('%.17g', argument);
  else
    word = char(argument);
  end
end
