function [scale, units] = readable(units)
% The units that people read, mm for m and deg for rad {R x 1}, and by what [1 x R] SI is multiplied to have them.
  units = units(:);
  scale = ones(1, numel(units));
  scale(strcmp(units, 'm')) = 1000;
  scale(strcmp(units, 'rad')) = 180 / pi;
  units(strcmp(units, 'm')) = {'mm'};
  units(strcmp(units, 'rad')) = {'deg'};
end
