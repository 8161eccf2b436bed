function files = paper_figures(runs, folder)
% PAPER_FIGURES  Draws the figures of the paper from MAT-files of fogline export.
%
%   paper_figures('run.mat', 'figures') draws the run in run.mat into the folder figures, as
%   speeds.svg, gaps.svg, conflict.svg and accelerations.svg.
%   paper_figures({'with.mat', 'without.mat'}, 'figures') draws the runs side by side.
%   The result is a list of the files. The function runs in Octave and in MATLAB, without a display:
%
%     fogline run scenario/paper.json --log with.lcm
%     fogline run scenario/paper.json --set /arbitrator/policy=none --log without.lcm
%     fogline export with.lcm --out with.mat && fogline export without.lcm --out without.mat
%     octave-cli --path tools/export --eval "paper_figures({'with.mat', 'without.mat'}, 'figures')"
%
% Times are in s, distances in m. Grey lines: beginning and end of the fog.
  if ischar(runs), runs = {runs}; end
  if exist('OCTAVE_VERSION', 'builtin')
    warning('off', 'Octave:gnuplot-graphics');
    graphics_toolkit('gnuplot');  % the only one that needs no display
  end
  if ~exist(folder, 'dir'), mkdir(folder); end
  loaded = cell(size(runs));
  for i = 1:numel(runs), loaded{i} = load(runs{i}); end
  names = {'speeds', 'gaps', 'conflict', 'accelerations'};
  draw = {@speeds, @gaps, @conflict, @accelerations};
  files = cell(size(names));
  for k = 1:numel(names)
    f = figure('visible', 'off', 'paperunits', 'inches', ...
               'paperposition', [0 0 6 * numel(loaded) 5]);
    for i = 1:numel(loaded)
      subplot(1, numel(loaded), i);
      draw{k}(loaded{i});
      title(label(runs{i}, loaded{i}), 'interpreter', 'none');
      xlabel('time (s)');
      grid on;
    end
    files{k} = fullfile(folder, [names{k} '.svg']);
    print(f, files{k}, '-dsvg');
    close(f);
  end
end

function speeds(run)
  t = seconds_of(run.TRUTH);
  plot(t, run.TRUTH.preceding_speed_mps, t, run.TRUTH.host_speed_mps, ...
       t, run.TRUTH.follower_speed_mps(:, 1));
  finish(run, 'speed (m/s)', {'preceding car', 'host', 'following car'});
end

function gaps(run)
  t = seconds_of(run.TRUTH);
  plot(t, run.TRUTH.follower_gap_m(:, 1), ...
       seconds_of(run.FOLLOWER_COMMAND), run.FOLLOWER_COMMAND.safe_distance_m(:, 1), '--');
  finish(run, 'distance (m)', {'gap of the following car', 'its safe distance'});
end

function conflict(run)
  t = seconds_of(run.HOST_COMMAND);
  plot(t, run.HOST_COMMAND.doc, t, run.HOST_COMMAND.threshold, '--', ...
       t, run.HOST_COMMAND.lambda_human);
  finish(run, 'Degree of Conflict', {'Degree of Conflict', 'threshold', 'authority of the human'});
end

function accelerations(run)
  plot(seconds_of(run.ACC_COMMAND), run.ACC_COMMAND.acceleration_mps2, ':', ...
       seconds_of(run.DRIVER_COMMAND), run.DRIVER_COMMAND.acceleration_mps2, ':', ...
       seconds_of(run.HOST_COMMAND), run.HOST_COMMAND.acceleration_mps2);
  finish(run, 'acceleration (m/s^2)', {'automation wants', 'human wants', 'host'});
end

function finish(run, quantity, names)
% Marks the fog, and adds the names.
  set(get(gca, 'children'), 'linewidth', 1.5);
  ylabel(quantity);
  limits = ylim();
  t = seconds_of(run.TRUTH);
  fog = t(run.TRUTH.fog_present ~= 0);
  if ~isempty(fog)
    hold on;
    plot([fog(1) fog(1)], limits, 'color', [0.6 0.6 0.6]);
    plot([fog(end) fog(end)], limits, 'color', [0.6 0.6 0.6]);
    hold off;
    names = [names {'fog begins', 'fog ends'}];
  end
  ylim(limits);
  legend(names, 'location', 'southoutside');
end

function t = seconds_of(channel)
  t = double(channel.header.utime) / 1e6;
end

function text = label(file, run)
  [~, name] = fileparts(file);
  scenario = jsondecode(run.scenario);
  text = sprintf('%s (seed %d)', name, scenario.seed);
end
