function result = read_results(source, response, figure_file)
% READ_RESULTS  What a poesy study found: poesy.read and poesy.plot in one call, as a start for scripts of your own.
%
%   result = read_results('study.h5')     the result file, or the folder that `poesy export study.h5 -d tables` wrote
%   read_results(source)                  draws what each error of a sensitivity study does to the displacement of the tool,
%                                         without a tool of the platform, else to the first response that is a length
%   read_results(source, 'angular_deformation')                          to another response
%   result = read_results(source, 'linear_deformation', 'ranked.svg')    writes the figure to a file
%
% Of a sensitivity study result has the indices with names and intervals, ranked: help poesy.internal.indices. Of any other
% kind it is what poesy.read gives. For figures of other kinds, take poesy.plot.
  found = poesy.read(source);
  if ~strcmp(found.kind, 'sensitivity')
    if nargin > 1 || nargout == 0
      error('read_results:kind', '%s: of kind %s, which has no indices to rank or draw; take poesy.plot(''%s'')', ...
            source, found.kind, source);
    end
    result = found;
    return
  end
  result = found.sensitivity;
  if nargin < 2
    response = '';
  end
  ranked = poesy.ranking(found, response);  %#ok<NASGU> an error where there is no such response
  if nargin > 2
    poesy.plot(found, response, figure_file);
  elseif nargout == 0
    poesy.plot(found, response);
  end
end
