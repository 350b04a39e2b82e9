function result = read(source)
% POESY.READ  What a poesy study of any kind found.
%
%   result = poesy.read('study.h5')    a result file. MATLAB reads it itself; Octave, which cannot, lets poesy export it.
%                                      MATLAB follows links into other files; `poesy verify` refuses a file that has any
%   result = poesy.read('tables')      the folder that `poesy export study.h5 -d tables` wrote
%
% result.kind is 'sensitivity', 'identification', 'evaluate', 'monte-carlo', 'sobol', 'allocation', 'coupling', 'sweep' or
% 'calibration'.
%
% result.ranked, the same in MATLAB and Octave, is what poesy.ranking sorts and poesy.plot draws. Of N rows and R columns:
%   what                       what the numbers are, in words
%   names                      {N x 1}  errors, groups, parts, subsets of sources, or rows of errors
%   responses, units           {R x 1}  the columns: responses (groups of sizes of an identification), and their units: mm, deg
%   value, low, high           [N x R]  numbers, and their intervals; NaN where there is none
%   smallest_first             [1 x R]  true where a smaller number is better: costs of a sweep
% A sensitivity study has index x sigma, a Monte Carlo study S1 (where it has first-order indices), a Sobol' study ST, an
% allocation each part's share of the cost, a coupling the largest effect over the poses, an identification what each error
% gives alone (SI), a sweep the figures of merit of each design in the units of poesy show, a calibration each estimate's
% magnitude over its standard deviation, and an evaluation the largest magnitude over the poses (from tables also of what is
% beside responses).
%
% All numbers are there too, in SI. Read from tables, result.tables.NAME for each NAME.csv:
%   columns, units             {C x 1}  names of the columns, and their units ('1' for none)
%   rows                       {N x 1}  the first column as text: names of cases, numbers of poses, ...
%   cells                      {N x C}  all cells as text
%   values                     [N x C]  all cells as numbers, NaN where a cell is text
% Read from a file by MATLAB, result.groups.GROUP.DATASET, as h5read gives them: axes in reversed order.
% A sensitivity study also has result.sensitivity, its indices; see POESY.INTERNAL.INDICES.
  source = char(source);
  if exist(source, 'dir') == 7
    result = poesy.internal.from_tables(source);
  elseif exist(source, 'file') ~= 2
    error('poesy:absent', '%s: there is no such file or folder', source);
  elseif exist('h5read') ~= 0  %#ok<EXIST> a function in MATLAB, a file elsewhere
    result = poesy.internal.from_file(source);
  else
    folder = tempname();
    removed = onCleanup(@() poesy.internal.remove_folder(folder));
    poesy.internal.program({'export', source, '-d', folder});
    result = poesy.internal.from_tables(folder);
  end
end
