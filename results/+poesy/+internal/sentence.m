function said = sentence(said)
% Of all that the program printed, the line in which it says what is wrong; all of it where there is none.
  said = strtrim(said);
  line = regexp(said, '(?<=^|\n)poesy: [^\n]*', 'match', 'once');
  if ~isempty(line)
    said = line(8:end);
  end
end
