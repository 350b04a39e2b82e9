% MATLAB's h5readatt, for tests in Octave, of attributes of the root. As there, an attribute that is not there is an error.
function value = h5readatt(file, group, attribute)
  value = h5_contents(file)([group '@' attribute]);
end
