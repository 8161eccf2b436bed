% Jerk of the host averaged over 1 s, as ISO 15622 measures it, from the CSV files of one run.
%
% The script checks Fogline's measures and shares no code with Fogline: it reads the files that
% `fogline export` wrote. It finds the acceleration one second earlier by interpolation of a step
% function.
%
%   octave-cli tests/campaign/peers/jerk.m FOLDER      FOLDER/TRUTH.csv, HOST_COMMAND.csv, scenario.json
%
% The script prints two values as JSON: the largest jerk of the whole run, and the largest jerk
% after changes of the authorities.
1;

function values = column(file, name)
  stream = fopen(file);
  names = strsplit(fgetl(stream), ',');
  fclose(stream);
  cells = dlmread(file, ',', 1, 0);
  values = cells(:, find(strcmp(names, name)));
end

folder = argv(){1};
truth = fullfile(folder, 'TRUTH.csv');
host = fullfile(folder, 'HOST_COMMAND.csv');
handover = jsondecode(fileread(fullfile(folder, 'scenario.json'))).measures.handover_s;

us = column(truth, 'header.utime');
applied = column(truth, 'host_acceleration_mps2');
human = column(host, 'lambda_human');
assert(numel(us) == numel(human), 'a step lacks a message');
us(1) = []; applied(1) = [];               % step 0: nothing was applied

% The acceleration in row k was applied from the step before until step k. So a time between two
% rows has the acceleration of the later row.
before = interp1(us, applied, us - 1e6, 'next', NaN);
jerk = abs(applied - before);              % averaged over 1 s
known = !isnan(jerk);

% The command of step k acts from step k on. So only the applied accelerations of later steps show
% this command.
changes = us(diff(human) != 0);            % row k of `us` is step k
after = false(size(us));
for change = changes'
  after |= us > change & us <= change + round(handover * 1e6);
end
result.max_abs_jerk_1s_mps3 = max(jerk(known));
result.max_handover_jerk_1s_mps3 = max([NaN; jerk(known & after)]);
disp(jsonencode(result));
