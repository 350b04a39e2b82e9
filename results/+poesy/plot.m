function plot(result, response, figure_file)
% POESY.PLOT  Draws a ranking of a result of any kind: a bar for each row, with its interval, as POESY.RANKING sorts.
%
%   poesy.plot(result)                                          in a new figure
%   poesy.plot(result, 'angular_deformation')                   of another response
%   poesy.plot(result, 'linear_deformation', 'ranked.svg')      into a file, without a window
%
% result and response are as for POESY.RANKING.
  if nargin < 2
    response = '';
  end
  ranked = poesy.ranking(result, response);
  place = [100, 100, 640, 140 + 18 * numel(ranked.names)];
  if nargin < 3
    figure('Position', place);
    draw(ranked);
  else
    f = figure('Visible', 'off', 'Position', place, 'PaperPositionMode', 'auto');
    draw(ranked);
    saveas(f, figure_file);
    close(f);
  end
end

% Bars of what has no number have no length.
function draw(ranked)
  rows = 1:numel(ranked.names);
  lengths = ranked.value(:)';
  lengths(~isfinite(lengths)) = 0;
  barh(rows, lengths);
  line([ranked.low(:), ranked.high(:)]', [rows; rows], 'Color', 'k');
  set(gca(), 'YDir', 'reverse', 'YTick', rows, 'YLim', [0.4, numel(rows) + 0.6], 'TickLabelInterpreter', 'none');
  names = ranked.names;
  if exist('OCTAVE_VERSION', 'builtin') ~= 0 && strcmp(graphics_toolkit(), 'gnuplot')
    names = strrep(names, '_', '\\_');  % gnuplot takes them for subscripts all the same
  end
  set(gca(), 'YTickLabel', names);
  unit = '';
  if ~strcmp(ranked.unit, '1')
    unit = [' [' ranked.unit ']'];
  end
  xlabel([ranked.what unit]);
  title(ranked.response, 'Interpreter', 'none');
end
