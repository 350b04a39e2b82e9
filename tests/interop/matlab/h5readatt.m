% MATLAB's h5readatt, for tests in Octave. As there, an attribute that is not there is an error.
function value = h5readatt(file, group, attribute)
  value = h5_values(file, group, attribute);
end
