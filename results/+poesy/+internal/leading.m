function names = leading(result)
% Names of the responses that come first where they are ranked: those with limits, the one whose limit is missed most often
% before the others, then the displacements of the tool and of the platform. A result need not have them.
  names = {};
  if isfield(result, 'tables') && isfield(result.tables, 'limits')
    limits = result.tables.limits;
    names = limits.rows;
    missed = 1 - limits.values(:, strcmp(limits.columns, 'within')) ./ limits.values(:, strcmp(limits.columns, 'tried'));
  elseif isfield(result, 'groups') && isfield(result.groups, 'limits')
    limits = result.groups.limits;
    names = limits.response;
    missed = 1 - double(limits.within(:)) ./ double(limits.tried(:));
  end
  if ~isempty(names)
    [~, order] = sort(missed, 'descend');
    names = reshape(names(order), [], 1);
  end
  names = [names; {'tip_position'; 'position'}];
end
