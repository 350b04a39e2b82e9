% MATLAB's h5read, for tests in Octave: the values in the order of the file, their dimensions reversed.
function data = h5read(file, dataset)
  data = h5_contents(file)(dataset);
end
