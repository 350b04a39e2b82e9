% Scheme I of Du et al. 2022 in plain Octave, written along the paper, one sample at a time: the same job as the solver
% of this project. Departs from the paper where it must: the logarithm of Eq. A6 is 0/0 at the identity, and a change
% of the residual that stays at rounding level ends a solve as a change below the tolerance does.
%
% usage: octave-cli solver_octave.m FOLDER STEP
%
% Reads FOLDER/samples.csv and background.csv (see published_samples.cpp), solves every STEP-th sample, writes
% FOLDER/solver_octave.csv (row, solved, iterations, angular_deformation, linear_deformation) and prints what that
% took.
1;  % a script, not a function file

function g = rot(axis, angle)
  c = cos(angle); s = sin(angle);
  g = eye(4);
  switch axis
    case 'x', g(2:3, 2:3) = [c, -s; s, c];
    case 'y', g([1, 3], [1, 3]) = [c, s; -s, c];
    case 'z', g(1:2, 1:2) = [c, -s; s, c];
  end
end

function g = trans(axis, distance)
  g = eye(4);
  g(find('xyz' == axis), 4) = distance;
end

function m = hat(w)
  m = [0, -w(3), w(2); w(3), 0, -w(1); -w(2), w(1), 0];
end

% Eq. A8
function a = Ad(g)
  R = g(1:3, 1:3);
  a = [R, zeros(3); hat(g(1:3, 4)) * R, R];
end

% Eqs. A2-A4 for the joints of Eq. 14: 'R' turns about z, 'P' slides along z.
function g = joint(type, q)
  if type == 'R', g = rot('z', q); else, g = trans('z', q); end
end

% Eq. 26, error = [delta; epsilon]
function g = error_motion(error)
  theta = norm(error(4:6));
  R = eye(3);
  if theta > 0
    w = hat(error(4:6));
    R = R + sin(theta) / theta * w + 2 * (sin(theta / 2) / theta)^2 * w * w;
  end
  g = [R, error(1:3); 0, 0, 0, 1];
end

% Eq. 30
function mu = logarithm(g)
  R = g(1:3, 1:3); p = g(1:3, 4);
  a = [R(3, 2) - R(2, 3); R(1, 3) - R(3, 1); R(2, 1) - R(1, 2)] / 2;
  theta = atan2(norm(a), (trace(R) - 1) / 2);
  if theta > 1e-4, w = theta / sin(theta) * a; else, w = (1 + theta^2 / 6) * a; end
  if theta > 0.05
    bend = (1 - theta / 2 * cot(theta / 2)) / theta^2;
  else
    bend = 1 / 12 + theta^2 * (1 / 720 + theta^2 * (1 / 30240 + theta^2 / 1209600));
  end
  mu = [w; p - cross(w, p) / 2 + bend * cross(w, cross(w, p))];
end

% Eqs. 1-12: angles and lengths q(i, j) at a pose.
function q = joint_variables(geo, z, beta, gamma)
  R = rot('x', beta)(1:3, 1:3) * rot('y', gamma)(1:3, 1:3);
  o = [0; -z * tan(beta); z];
  e1 = [1; 0; 0]; e2 = [0; 1; 0];
  BA1 = o + geo.l_A * R * e1 - geo.l_B * e1;
  BA2 = o - geo.l_A * R * e1 + geo.l_B * e1;
  BA3 = o + geo.l_A * R * e2 - geo.l_B * e2;
  A12 = -2 * geo.l_A * R * e1;
  q = [beta, acos(e1' * BA1 / norm(BA1)), norm(BA1), -acos(-A12' * BA1 / (norm(A12) * norm(BA1)));
       beta, acos(e1' * BA2 / norm(BA2)), norm(BA2), acos(A12' * BA2 / (norm(A12) * norm(BA2)));
       acos(-e2' * BA3 / norm(BA3)), norm(BA3), acos((R * e2)' * BA3 / norm(BA3)), gamma];
end

% Eqs. 15-23: frames{i, j + 1} is g_ij
function frames = home_frames(geo, home)
  frames = cell(3, 5);
  for i = 1:2
    side = 3 - 2 * i;
    a = home(i, 2);
    frames{i, 1} = trans('x', side * (geo.l_B + geo.d)) * rot('y', pi / 2);
    frames{i, 2} = trans('z', -side * geo.d) * rot('x', -pi / 2) * rot('z', a - pi / 2);
    frames{i, 3} = rot('y', pi / 2);
    frames{i, 4} = trans('z', home(i, 3)) * rot('y', -pi / 2) * rot('z', pi / 2 - a);
    frames{i, 5} = trans('y', side * geo.l_A) * rot('y', -pi / 2) * rot('z', -pi / 2);
  end
  a = home(3, 1);
  frames{3, 1} = trans('y', geo.l_B) * rot('y', pi / 2) * rot('z', a - pi / 2);
  frames{3, 2} = rot('y', pi / 2);
  frames{3, 3} = trans('z', home(3, 2)) * rot('y', -pi / 2) * rot('z', pi / 2 - a);
  frames{3, 4} = trans('y', -geo.c) * rot('x', -pi / 2);
  frames{3, 5} = trans('z', geo.c - geo.l_A) * rot('y', -pi / 2) * rot('z', -pi / 2);
end

% Eq. 28 and Psi_i Phi_i of Eqs. 32-39: a column for each passive joint.
function [g, columns] = limb(frames, types, q)
  g = frames{1};
  columns = zeros(6, 3);
  n = 0;
  for j = 1:4
    if types(j) == 'R'
      n = n + 1;
      columns(:, n) = Ad(g) * [0; 0; 1; 0; 0; 0];
    end
    g = g * joint(types(j), q(j)) * frames{j + 1};
  end
end

% Eqs. 30, 41 and 43
function [mu, J] = evaluate(frames, types, q)
  g = cell(1, 3); P = cell(1, 3);
  for i = 1:3
    [g{i}, P{i}] = limb(frames(i, :), types{i}, q(i, :));
  end
  mu = [logarithm(g{2} / g{1}); logarithm(g{3} / g{2}); logarithm(g{1} / g{3})];
  O = zeros(6, 3);
  J = [P{1}, -P{2}, O; O, P{2}, -P{3}; -P{1}, O, P{3}];
end

% Scheme I (Figure 3). errors{i, j + 1} = [delta_ij; epsilon_ij]
function [mu, solved, iteration] = scheme_1(frames, types, q, errors)
  for i = 1:3
    for j = 1:4
      frames{i, j} = error_motion(errors{i, j}) * frames{i, j};
    end
    frames{i, 5} = frames{i, 5} / error_motion(errors{i, 5});
  end
  solved = false; smallest = Inf; flat = 0;
  [mu, J] = evaluate(frames, types, q);
  for iteration = 1:50
    dq = (J' * J) \ (J' * mu);  % Eq. 44
    for i = 1:3
      passive = types{i} == 'R';
      q(i, passive) = q(i, passive) + dq(3 * i - 2:3 * i)';
    end
    previous = mu;
    [mu, J] = evaluate(frames, types, q);
    change = max(abs(mu - previous));
    if change < smallest, flat = 0; else, flat = flat + 1; end
    smallest = min(smallest, change);
    solved = change < 1e-15 || (change <= 64 * eps && flat >= 3);
    if solved, return; end
  end
end

% 'delta_1_0_x' is entry 1 of errors{1, 1}
function errors = set_error(errors, name, value)
  parts = strsplit(name, '_');
  entry = find('xyz' == parts{4}) + 3 * strcmp(parts{1}, 'epsilon');
  errors{str2double(parts{2}), str2double(parts{3}) + 1}(entry) = value;
end

function columns = read(path, format)
  file = fopen(path);
  columns = textscan(file, format, 'Delimiter', ',', 'HeaderLines', 1);
  fclose(file);
end

args = argv();
folder = args{1};
step = str2double(args{2});
background = read(fullfile(folder, 'background.csv'), '%s %f');
samples = read(fullfile(folder, 'samples.csv'), '%f %f %f %s %f');

geo = struct('l_A', 0.06, 'l_B', 0.15, 'c', 0.025, 'd', 0.115);
types = {'RRPR', 'RRPR', 'RPRR'};
home = joint_variables(geo, -0.2, 0, 0);
frames = home_frames(geo, home);
constant = repmat({zeros(6, 1)}, 3, 5);
for k = 1:numel(background{1})
  constant = set_error(constant, background{1}{k}, background{2}(k));
end

rows = 1:step:numel(samples{5});
answers = zeros(numel(rows), 5);
start = tic();
cpu_start = cputime();
for n = 1:numel(rows)
  k = rows(n);
  q = joint_variables(geo, samples{1}(k), samples{2}(k), samples{3}(k)) - home;
  errors = set_error(constant, samples{4}{k}, samples{5}(k));
  [mu, solved, iterations] = scheme_1(frames, types, q, errors);
  mu = reshape(mu, 6, 3);
  angular = mean(norm(mu(1:3, :), 'columns'));  % Eq. 49
  linear = mean(norm(mu(4:6, :), 'columns'));   % Eq. 50
  answers(n, :) = [k - 1, solved, iterations, angular, linear];
end
seconds = toc(start);
cpu_seconds = cputime() - cpu_start;

file = fopen(fullfile(folder, 'solver_octave.csv'), 'w');
fprintf(file, 'row,solved,iterations,angular_deformation,linear_deformation\n');
fprintf(file, '%d,%d,%d,%.17g,%.17g\n', answers');
fclose(file);
printf(['{"processes": 1, "solves": %d, "seconds": %.4f, "cpu_seconds": %.4f, "iterations_per_solve": %.3f, ' ...
        '"version": "%s"}\n'], numel(rows), seconds, cpu_seconds, mean(answers(:, 3)), version());
