function [said, code] = program(arguments, accepted)
% Runs poesy with the arguments, a cell array of text. An exit code that is neither 0 nor in accepted is an error
% (poesy:exitN) with the program's own sentence. said is what it printed.
  if nargin < 2
    accepted = [];
  end
  name = getenv('POESY');
  if isempty(name)
    name = 'poesy';
  end
  words = cellfun(@quoted, [{name}, arguments], 'UniformOutput', false);
  command = [strjoin(words, ' ') ' 2>&1'];
  if isunix() && exist('OCTAVE_VERSION', 'builtin') == 0
    command = ['env -u LD_LIBRARY_PATH ' command];  % MATLAB puts the folders of its own libraries there
  end
  [code, said] = system(command);
  if code == 127 || code == 9009  % the words of a POSIX shell and of Windows for a command that is not there
    error('poesy:program', ['%s: the program is not there; put its folder into PATH, or say setenv(''POESY'', ' ...
          '''/path/to/poesy''). Without it, "poesy export RESULT.h5 -d tables" elsewhere gives a folder to read'], name);
  end
  if code ~= 0 && ~any(code == accepted)
    error(sprintf('poesy:exit%d', code), '%s', poesy.internal.sentence(said));
  end
end

function word = quoted(argument)
  if ispc()
    word = ['"' argument '"'];
  else
    word = ['''' strrep(argument, '''', '''\''''') ''''];
  end
end
